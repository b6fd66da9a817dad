# Piezoelectric stack with Maxwell-slip: 40 um at 150 V: irreversible port-Hamiltonian system.
#
# Source:  Goldfarb, Celanovic (1997), Modeling piezoelectric stack actuators; loop measured by Chandra et al. (2023), doi 10.1063/5.0146134
# Model:   stack_maxwell, spec sha256 a4fac994b19a17a907de6d8bbc2fec285a640ebfd27501f5fec69ade7095faff
# System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
#          rows, multiplied out; `piezo-sym show` prints the matrices
# Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, rate-independent, sigma, exergy, environment, units, program PROVED
#          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
#          parameters in the domain, and for banks of any size)
#
# Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
# Julia; values are in SI units.
#
# x = (Q, p, q, z_1 ... z_slips_count, S)
# u = (F_ext, V_in, T_e)
# p_ = NamedTuple, with an underscore beside the model's own p
# bank slips: lanes j = 1 ... slips_count

pow(x, w) = x^w
deadzone(z, w) = max(z - w, 0.0) + min(z + w, 0.0)
saturate(z, w) = clamp(z, -w, w)

const stack_maxwell_parameters = (; m = 0.02, d = 100.0, a = 6.0, C = 6.4e-06, R = 10.0, k = 24560000.0, k_s = [11270000.0, 1056000.0, 4535000.0, 2234000.0, 744300.0, 4553000.0, 1170000.0, 12980000.0], r = [2.35e-06, 4.7e-06, 7.05e-06, 9.4e-06, 1.175e-05, 1.41e-05, 1.645e-05, 1.88e-05], T_0 = 296.15, c_0 = 5.0, lam = 0.05, slips_count = 8)

function stack_maxwell_rhs!(dx, x, u, p_)
    slips_count = p_.slips_count
    m = p_.m
    d = p_.d
    a = p_.a
    C = p_.C
    R = p_.R
    k = p_.k
    k_s = p_.k_s .* ones(slips_count)
    r = p_.r .* ones(slips_count)
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    Q = x[1]
    p = x[2]
    q = x[3]
    z = x[4 : 3 + slips_count]
    S = x[3 + slips_count + 1]
    F_ext = u[1]
    V_in = u[2]
    T_e = u[3]
    V_clamped = Q/C
    v_mass = p/m
    F_spring = k*q
    F_slips = @. k_s*z
    T = T_0*exp(S/c_0)
    sum_F_slips = sum(@. F_slips)
    alpha_ceramic = a
    V_leads = -V_clamped + V_in
    i_leads = V_leads/R
    F_damper = d*v_mass
    slip_slips = @. ifelse(v_mass > 0.0, ifelse(F_slips >= k_s*r, v_mass, 0.0), ifelse(F_slips <= -k_s*r, v_mass, 0.0))
    heat_leads = i_leads*V_leads
    heat_slips = sum(@. slip_slips*F_slips)
    heat_damper = F_damper*v_mass
    dx[1] = i_leads - alpha_ceramic*v_mass
    dx[2] = alpha_ceramic*V_clamped - F_spring - sum_F_slips - F_damper + F_ext
    dx[3] = v_mass
    dx[4 : 3 + slips_count] .= @. v_mass - slip_slips
    dx[3 + slips_count + 1] = (heat_leads + heat_slips + heat_damper)/T + lam*(T_e/T - 1.0)
    return dx
end
