# Piezoelectric stack of 3 layers that conduct heat: irreversible port-Hamiltonian system.
#
# Source:  Caballeria, Ramirez, Le Gorrec (2021), eqs. (9)-(13), Table 1, cut into layers; conductance between them: a choice
# Model:   layered_stack, spec sha256 b46e92f413d7be38d2b0d17c8e7e220000a9ea90d48a027e94b79d81ff92ba5e
# System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
#          rows, multiplied out; `piezo-sym show` prints the matrices
# Proofs:  skew, casimir, temperature, energy, entropy, welldef, continuous, passive, odd, sigma, exergy, environment, invariant, units, program PROVED
#          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
#          parameters in the domain, and for banks of any size)
#
# Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
# Julia; values are in SI units.
#
# x = (q_1, p_1, Q_1, phi_1, S_1, q_2, p_2, Q_2, phi_2, S_2, q_3, p_3, Q_3, phi_3, S_3)
# u = (F_ext, V_in, T_e)
# p = NamedTuple

pow(x, w) = x^w
deadzone(z, w) = max(z - w, 0.0) + min(z + w, 0.0)
saturate(z, w) = clamp(z, -w, w)

const layered_stack_parameters = (; M = 0.00225, k = 1500000.0, d = 1200.0, C = 1.6666666666666667e-06, L = 0.0015, rho = 15.0, i_0 = 0.3333333333333333, a = 10.0, T_0 = 296.15, c_0 = 1.6666666666666667, lam = 1.0, lam_l = 6.0)

function layered_stack_rhs!(dx, x, u, p)
    M = p.M
    k = p.k
    d = p.d
    C = p.C
    L = p.L
    rho = p.rho
    i_0 = p.i_0
    a = p.a
    T_0 = p.T_0
    c_0 = p.c_0
    lam = p.lam
    lam_l = p.lam_l
    q_1 = x[1]
    p_1 = x[2]
    Q_1 = x[3]
    phi_1 = x[4]
    S_1 = x[5]
    q_2 = x[6]
    p_2 = x[7]
    Q_2 = x[8]
    phi_2 = x[9]
    S_2 = x[10]
    q_3 = x[11]
    p_3 = x[12]
    Q_3 = x[13]
    phi_3 = x[14]
    S_3 = x[15]
    F_ext = u[1]
    V_in = u[2]
    T_e = u[3]
    F_spring_1 = k*q_1
    v_mass_1 = p_1/M
    V_capacitor_1 = Q_1/C
    i_hysteron_1 = phi_1/L
    T_body_1_minus_T_0 = T_0*expm1(S_1/c_0)
    T_body_1 = T_0 + T_body_1_minus_T_0
    F_spring_2 = k*q_2
    v_mass_2 = p_2/M
    V_capacitor_2 = Q_2/C
    i_hysteron_2 = phi_2/L
    T_body_2_minus_T_0 = T_0*expm1(S_2/c_0)
    T_body_2 = T_0 + T_body_2_minus_T_0
    F_spring_3 = k*q_3
    v_mass_3 = p_3/M
    V_capacitor_3 = Q_3/C
    i_hysteron_3 = phi_3/L
    T_body_3_minus_T_0 = T_0*expm1(S_3/c_0)
    T_body_3 = T_0 + T_body_3_minus_T_0
    alpha_transducer_1 = a*T_body_1/T_0
    alpha_transducer_2 = a*T_body_2/T_0
    alpha_transducer_3 = a*T_body_3/T_0
    V_hysteron_1 = rho/T_body_1_minus_T_0*deadzone(i_hysteron_1, i_0)
    F_damper_1 = d*v_mass_1
    V_hysteron_2 = rho/T_body_2_minus_T_0*deadzone(i_hysteron_2, i_0)
    v_damper_2 = -v_mass_1 + v_mass_2
    F_damper_2 = d*v_damper_2
    V_hysteron_3 = rho/T_body_3_minus_T_0*deadzone(i_hysteron_3, i_0)
    v_damper_3 = -v_mass_2 + v_mass_3
    F_damper_3 = d*v_damper_3
    s_contact_1 = lam_l*(T_body_1 - T_body_2)/T_body_1
    s_contact_2 = lam_l*(T_body_2 - T_body_3)/T_body_2
    heat_hysteron_1 = V_hysteron_1*i_hysteron_1
    heat_damper_1 = F_damper_1*v_mass_1
    heat_hysteron_2 = V_hysteron_2*i_hysteron_2
    heat_damper_2 = F_damper_2*v_damper_2
    heat_hysteron_3 = V_hysteron_3*i_hysteron_3
    heat_damper_3 = F_damper_3*v_damper_3
    heat_contact_1 = s_contact_1*T_body_1
    heat_contact_2 = s_contact_2*T_body_2
    dx[1] = v_mass_1
    dx[2] = alpha_transducer_1*V_capacitor_1 - F_spring_1 + F_spring_2 - alpha_transducer_2*V_capacitor_2 - F_damper_1 + F_damper_2
    dx[3] = i_hysteron_1 - alpha_transducer_1*v_mass_1
    dx[4] = V_in - V_capacitor_1 - V_hysteron_1
    dx[5] = (heat_hysteron_1 + heat_damper_1)/T_body_1 - s_contact_1 + lam*(T_e/T_body_1 - 1.0)
    dx[6] = v_mass_2 - v_mass_1
    dx[7] = alpha_transducer_2*V_capacitor_2 - F_spring_2 + F_spring_3 - alpha_transducer_3*V_capacitor_3 - F_damper_2 + F_damper_3
    dx[8] = alpha_transducer_2*v_mass_1 - alpha_transducer_2*v_mass_2 + i_hysteron_2
    dx[9] = V_in - V_capacitor_2 - V_hysteron_2
    dx[10] = (heat_hysteron_2 + heat_damper_2 + heat_contact_1)/T_body_2 - s_contact_2
    dx[11] = v_mass_3 - v_mass_2
    dx[12] = alpha_transducer_3*V_capacitor_3 - F_spring_3 - F_damper_3 + F_ext
    dx[13] = alpha_transducer_3*v_mass_2 - alpha_transducer_3*v_mass_3 + i_hysteron_3
    dx[14] = V_in - V_capacitor_3 - V_hysteron_3
    dx[15] = (heat_hysteron_3 + heat_damper_3 + heat_contact_2)/T_body_3 + lam*(T_e/T_body_3 - 1.0)
    return dx
end
