# Piezoelectric stack with a lever, a load and an end stop: irreversible port-Hamiltonian system.
#
# Source:  Scire, Teague (1978), Rev. Sci. Instrum. 49 (12), 1735-1740 (levers); Hunt, Crossley (1975), J. Appl. Mech. 42 (2), 440-445 (end stop); PiezoDrive SA050536
# Model:   amplified_stack, spec sha256 f97db543e4f43ea0e60de47bf6de8bd925540145e93c475ce6262cae7eb13898
# System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
#          rows, multiplied out; `piezo-sym show` prints the matrices
# Proofs:  skew, casimir, temperature, welldef, energy, entropy, passive, odd, continuous, sigma, exergy, environment, units, program PROVED
#          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
#          parameters in the domain, and for banks of any size)
#
# Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
# Julia; values are in SI units.
#
# x = (Q, q, p, x, x_e, S)
# u = (F, V, T_e)
# p_ = NamedTuple, with an underscore beside the model's own p

pow(x, w) = x^w
deadzone(z, w) = max(z - w, 0.0) + min(z + w, 0.0)
saturate(z, w) = clamp(z, -w, w)

const amplified_stack_parameters = (; k = 28000000.0, m_s = 0.0029, a = 8.7, C = 1.6e-06, R = 10.0, n = 8.0, m = 0.02, k_l = 100000.0, d = 3.5, g = 0.00025, k_e = 10000000.0, d_e = 5000000.0, T_0 = 293.15, c_0 = 2.6, lam = 0.02)

function amplified_stack_rhs!(dx, x_, u, p_)
    k = p_.k
    m_s = p_.m_s
    a = p_.a
    C = p_.C
    R = p_.R
    n = p_.n
    m = p_.m
    k_l = p_.k_l
    d = p_.d
    g = p_.g
    k_e = p_.k_e
    d_e = p_.d_e
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    Q = x_[1]
    q = x_[2]
    p = x_[3]
    x = x_[4]
    x_e = x_[5]
    S = x_[6]
    F = u[1]
    V = u[2]
    T_e = u[3]
    V_clamped = Q/C
    F_stack = k*q
    v_load = p/(m + m_s/n^2)
    F_spring = k_l*x
    F_end_stop = k_e*max(x_e - g, 0.0)
    T = T_0*exp(S/c_0)
    alpha_ceramic = a
    n_lever = n
    V_leads = -V_clamped + V
    i_leads = V_leads/R
    F_losses = d*v_load
    F_bumper = d_e*max(x_e - g, 0.0)*v_load
    heat_leads = i_leads*V_leads
    heat_losses = F_losses*v_load
    heat_bumper = F_bumper*v_load
    dx[1] = i_leads - alpha_ceramic/n_lever*v_load
    dx[2] = v_load/n_lever
    dx[3] = alpha_ceramic/n_lever*V_clamped - F_stack/n_lever - F_spring - F_end_stop - F_losses - F_bumper + F
    dx[4] = v_load
    dx[5] = v_load
    dx[6] = (heat_leads + heat_losses + heat_bumper)/T + lam*(T_e/T - 1.0)
    return dx
end
