# Piezoelectric stack actuator with hysterons: irreversible port-Hamiltonian system.
#
# Source:  Caballeria, Ramirez, Le Gorrec (2021), eqs. (9)-(13), Table 1
# Model:   piezo_stack, spec sha256 9c0235a60e02072bc451611ffa723f273272c8e4536a3089081866f47c89389c
# System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
#          rows, multiplied out; `piezo-sym show` prints the matrices
# Proofs:  skew, casimir, temperature, energy, entropy, welldef, continuous, passive, odd, sigma, exergy, environment, invariant, units, program PROVED
#          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
#          parameters in the domain, and for banks of any size)
#
# Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
# Julia; values are in SI units.
#
# x = (q, p, Q_C, phi_1 ... phi_hysteron_count, S)
# u = (F_ext, V_in, T_e)
# p_ = NamedTuple, with an underscore beside the model's own p
# bank hysteron: lanes j = 1 ... hysteron_count

pow(x, w) = x^w
deadzone(z, w) = max(z - w, 0.0) + min(z + w, 0.0)
saturate(z, w) = clamp(z, -w, w)

const piezo_stack_parameters = (; M = 0.0035, k = 500000.0, q_l = 0.0, d = 400.0, C = 5e-06, L = 0.001, rho = 10.0, i_0 = 0.5, a = 10.0, T_0 = 296.15, c_0 = 5.0, lam = 2.0, hysteron_count = 2)

function piezo_stack_rhs!(dx, x, u, p_)
    hysteron_count = p_.hysteron_count
    M = p_.M
    k = p_.k
    q_l = p_.q_l
    d = p_.d
    C = p_.C
    L = p_.L .* ones(hysteron_count)
    rho = p_.rho .* ones(hysteron_count)
    i_0 = p_.i_0 .* ones(hysteron_count)
    a = p_.a
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    q = x[1]
    p = x[2]
    Q_C = x[3]
    phi = x[4 : 3 + hysteron_count]
    S = x[3 + hysteron_count + 1]
    F_ext = u[1]
    V_in = u[2]
    T_e = u[3]
    F_spring = k*(q - q_l)
    v_mass = p/M
    V_capacitor = Q_C/C
    i_hysteron = @. phi/L
    T_minus_T_0 = T_0*expm1(S/c_0)
    T = T_0 + T_minus_T_0
    sum_i_hysteron = sum(@. i_hysteron)
    alpha_transducer = a*T/T_0
    V_hysteron = @. rho/T_minus_T_0*deadzone(i_hysteron, i_0)
    F_damper = d*v_mass
    heat_hysteron = sum(@. V_hysteron*i_hysteron)
    heat_damper = F_damper*v_mass
    dx[1] = v_mass
    dx[2] = alpha_transducer*V_capacitor - F_spring - F_damper + F_ext
    dx[3] = sum_i_hysteron - alpha_transducer*v_mass
    dx[4 : 3 + hysteron_count] .= @. V_in - V_capacitor - V_hysteron
    dx[3 + hysteron_count + 1] = (heat_hysteron + heat_damper)/T + lam*(T_e/T - 1.0)
    return dx
end
