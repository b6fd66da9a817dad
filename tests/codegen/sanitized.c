/* Calls every function of the actuator with arrays of just the size that it writes and reads. */
#include "piezo_stack.c"

#include <stdio.h>
#include <stdlib.h>

static double *filled(long size, double value)
{
    double *array = malloc((size_t)size*sizeof *array);
    for (long n = 0; n < size; ++n) {
        array[n] = value;
    }
    return array;
}

static double sum(double *array, long size)
{
    double total = 0.0;
    for (long n = 0; n < size; ++n) {
        total += array[n];
    }
    free(array);
    return total;
}

static double all(long r)
{
    const long short_of = 0;
    double *inductance = filled(r, 1e-3), *slope = filled(r, 10.0), *threshold = filled(r, 0.5);
    piezo_stack_parameters p = {3.5e-3, 5e5,       0.0,  400.0,  5e-6, inductance, slope,
                                threshold, 10.0, 296.15, 5.0,  2.0,        r};
    const long n = piezo_stack_states(&p), rows = piezo_stack_processes(&p);
    double *u = filled(piezo_stack_input_count, 300.0), *x = filled(n, 1e-3);
    double *rate = filled(n - short_of, 0.0), *jacobian = filled(n*n, 0.0);
    double *y = filled(piezo_stack_output_count, 0.0), *power = filled(piezo_stack_output_count, 0.0);
    double *hot = filled(piezo_stack_body_count, 0.0), *heat = filled(rows, 0.0);
    double *produced = filled(rows, 0.0), *inside = filled(piezo_stack_condition_count, 0.0);
    double *start = filled(n, 0.0);
    piezo_stack_initial_state(u, &p, start);
    piezo_stack_rhs(x, u, &p, rate);
    piezo_stack_jacobian(x, u, &p, jacobian);
    piezo_stack_outputs(x, u, &p, y);
    piezo_stack_supply(x, u, &p, power);
    piezo_stack_temperatures(x, &p, hot);
    piezo_stack_heat(x, u, &p, heat);
    piezo_stack_entropy_production(x, u, &p, produced);
    piezo_stack_margins(x, u, &p, inside);
    double total = piezo_stack_energy(x, &p) + piezo_stack_entropy(x, &p);
    total += sum(rate, n - short_of) + sum(jacobian, n*n) + sum(y, piezo_stack_output_count);
    total += sum(power, piezo_stack_output_count) + sum(hot, piezo_stack_body_count);
    total += sum(heat, rows) + sum(produced, rows) + sum(inside, piezo_stack_condition_count);
    total += sum(start, n);
    free(inductance);
    free(slope);
    free(threshold);
    free(u);
    free(x);
    return total;
}

int main(void)
{
    const long sizes[] = {1, 2, 3, 17};
    for (int n = 0; n < 4; ++n) {
        const double total = all(sizes[n]);
        printf("%s %ld\n", total - total == 0.0 ? "good" : "not finite", sizes[n]);
    }
    return 0;
}
