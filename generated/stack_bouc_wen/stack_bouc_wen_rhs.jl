# Piezoelectric stack with a Bouc-Wen hysteresis of its voltage: irreversible port-Hamiltonian system.
#
# Source:  Goldfarb, Celanovic (1997), IEEE Control Systems 17 (3), 69-79; Low, Guo (1995), J. Microelectromech. Syst. 4 (4), 230-237; PiezoDrive SA050536
# Model:   stack_bouc_wen, spec sha256 cb2f5eb9e9a940796689ce0b466f2aabc3f9c62f14ebd031e4298cc6395703ff
# System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
#          rows, multiplied out; `piezo-sym show` prints the matrices
# Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, continuous, rate-independent, sigma, exergy, environment, units, program PROVED
#          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
#          parameters in the domain, and for banks of any size)
#
# Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
# Julia; values are in SI units.
#
# x = (q, p, Q, Q_h, S)
# u = (F_ext, V_in, T_e)
# p_ = NamedTuple, with an underscore beside the model's own p

pow(x, w) = x^w
deadzone(z, w) = max(z - w, 0.0) + min(z + w, 0.0)
saturate(z, w) = clamp(z, -w, w)

const stack_bouc_wen_parameters = (; m = 0.0029, k = 28000000.0, d = 10.0, a = 8.7, C = 5.3e-06, C_h = 9.3e-06, V_h = 10.0, beta = 0.6, gam = 0.4, n = 1.0, R = 2.0, c_0 = 2.6, lam = 0.02, T_0 = 293.15)

function stack_bouc_wen_rhs!(dx, x, u, p_)
    m = p_.m
    k = p_.k
    d = p_.d
    a = p_.a
    C = p_.C
    C_h = p_.C_h
    V_h = p_.V_h
    beta = p_.beta
    gam = p_.gam
    n = p_.n
    R = p_.R
    c_0 = p_.c_0
    lam = p_.lam
    T_0 = p_.T_0
    q = x[1]
    p = x[2]
    Q = x[3]
    Q_h = x[4]
    S = x[5]
    F_ext = u[1]
    V_in = u[2]
    T_e = u[3]
    F_spring = k*q
    v_mass = p/m
    V_ceramic = Q/C
    V_hysteresis = Q_h/C_h
    T = T_0*exp(S/c_0)
    alpha_transducer = a
    F_damper = d*v_mass
    V_leads = -V_ceramic - V_hysteresis + V_in
    i_leads = V_leads/R
    slip_hysteresis = (beta*abs(i_leads)*sign(V_hysteresis) + gam*i_leads)*pow(abs(V_hysteresis)/V_h, n)
    heat_damper = F_damper*v_mass
    heat_hysteresis = slip_hysteresis*V_hysteresis
    heat_leads = i_leads*V_leads
    dx[1] = v_mass
    dx[2] = alpha_transducer*V_ceramic - F_spring - F_damper + F_ext
    dx[3] = i_leads - alpha_transducer*v_mass
    dx[4] = i_leads - slip_hysteresis
    dx[5] = (heat_damper + heat_hysteresis + heat_leads)/T + lam*(T_e/T - 1.0)
    return dx
end
