# Ideal gas under a piston, with heat exchanged: irreversible port-Hamiltonian system.
#
# Source:  Ruechhardt (1929), Physikalische Zeitschrift 30, 58-59, the period; van der Schaft, Maschke (2018), Entropy 20, 925
# Model:   gas_piston, spec sha256 0a9d53c8700ddf1bb0d85a7756da7a071b3f29cf0a98843810acd07ee683352b
# System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
#          rows, multiplied out; `piezo-sym show` prints the matrices
# Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
#          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
#          parameters in the domain, and for banks of any size)
#
# Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
# Julia; values are in SI units.
#
# x = (p, q, S)
# u = (F, T_e)
# p_ = NamedTuple, with an underscore beside the model's own p

pow(x, w) = x^w
deadzone(z, w) = max(z - w, 0.0) + min(z + w, 0.0)
saturate(z, w) = clamp(z, -w, w)

const gas_piston_parameters = (; V_0 = 0.01, A = 0.0002, N = 0.41, c_v = 20.786, R = 8.314463, T_0 = 293.15, m = 0.0165, d = 0.005, lam = 0.05)

function gas_piston_rhs!(dx, x, u, p_)
    V_0 = p_.V_0
    A = p_.A
    N = p_.N
    c_v = p_.c_v
    R = p_.R
    T_0 = p_.T_0
    m = p_.m
    d = p_.d
    lam = p_.lam
    p = x[1]
    q = x[2]
    S = x[3]
    F = u[1]
    T_e = u[2]
    v_piston = p/m
    F_q = -N*c_v*T_0*exp(S/(N*c_v))*exp((-R)/c_v*log(1.0 + A*q/V_0))*R/c_v*A/(1.0 + A*q/V_0)/V_0
    T = N*c_v*T_0*exp(S/(N*c_v))/(N*c_v)*exp((-R)/c_v*log(1.0 + A*q/V_0))
    F_friction = d*v_piston
    heat_friction = F_friction*v_piston
    dx[1] = F - F_q - F_friction
    dx[2] = v_piston
    dx[3] = heat_friction/T + lam*(T_e/T - 1.0)
    return dx
end
