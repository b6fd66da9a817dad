# Series RLC circuit with a thermistor: irreversible port-Hamiltonian system.
#
# Source:  Becker, Green, Pearson (1946), Bell Syst. Tech. J. 26, 170-212, R = R_0 exp(B (1/T - 1/T_0))
# Model:   thermistor, spec sha256 b3ce3439410245bed29fbaef5d338f6c046728146ec30a1b29ddd4240ea71ae0
# System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
#          rows, multiplied out; `piezo-sym show` prints the matrices
# Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, units, program PROVED
#          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
#          parameters in the domain, and for banks of any size)
#
# Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
# Julia; values are in SI units.
#
# x = (phi, Q, S)
# u = ()
# p = NamedTuple

pow(x, w) = x^w
deadzone(z, w) = max(z - w, 0.0) + min(z + w, 0.0)
saturate(z, w) = clamp(z, -w, w)

const thermistor_parameters = (; L = 0.05, C = 2e-06, R_0 = 1000.0, B = 3000.0, c = 1e-06, T_0 = 300.0)

function thermistor_rhs!(dx, x, u, p)
    L = p.L
    C = p.C
    R_0 = p.R_0
    B = p.B
    c = p.c
    T_0 = p.T_0
    phi = x[1]
    Q = x[2]
    S = x[3]
    i_coil = phi/L
    V_cap = Q/C
    T = T_0*exp(S/c)
    V_bead = R_0*exp(B*(1.0/T - 1.0/T_0))*i_coil
    heat_bead = V_bead*i_coil
    dx[1] = V_cap - V_bead
    dx[2] = -i_coil
    dx[3] = heat_bead/T
    return dx
end
