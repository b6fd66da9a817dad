# Hydraulic cylinder behind an orifice, with a load and an end stop: irreversible port-Hamiltonian system.
#
# Source:  Merritt (1967), Hydraulic Control Systems, ch. 3 and 6
# Model:   hydraulic_cylinder, spec sha256 9f77f306d723282ed74a083c6c8af89eb009af63f004a1308f102f81527e5387
# System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
#          rows, multiplied out; `piezo-sym show` prints the matrices
# Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, continuous, sigma, exergy, environment, units, program PROVED
#          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
#          parameters in the domain, and for banks of any size)
#
# Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
# Julia; values are in SI units.
#
# x = (V, p, q, S)
# u = (p_in, F, T_e)
# p_ = NamedTuple, with an underscore beside the model's own p

pow(x, w) = x^w
deadzone(z, w) = max(z - w, 0.0) + min(z + w, 0.0)
saturate(z, w) = clamp(z, -w, w)

const hydraulic_cylinder_parameters = (; C_d = 0.6, a = 2e-06, rho = 870.0, p_t = 10000.0, A = 0.001, C_h = 5e-13, m = 50.0, d = 500.0, k_s = 10000000.0, x_s = 0.05, c = 500.0, lam = 5.0, T_0 = 313.15)

function hydraulic_cylinder_rhs!(dx, x, u, p_)
    C_d = p_.C_d
    a = p_.a
    rho = p_.rho
    p_t = p_.p_t
    A = p_.A
    C_h = p_.C_h
    m = p_.m
    d = p_.d
    k_s = p_.k_s
    x_s = p_.x_s
    c = p_.c
    lam = p_.lam
    T_0 = p_.T_0
    V = x[1]
    p = x[2]
    q = x[3]
    S = x[4]
    p_in = u[1]
    F = u[2]
    T_e = u[3]
    dp_chamber = V/C_h
    v_load = p/m
    F_stop = k_s*max(q - x_s, 0.0)
    T = T_0*exp(S/c)
    alpha_cylinder = A
    dp_orifice = -dp_chamber + p_in
    flow_orifice = C_d*a*sqrt(2.0/rho)*dp_orifice/(dp_orifice^2 + p_t^2)^0.25
    F_friction = d*v_load
    heat_orifice = flow_orifice*dp_orifice
    heat_friction = F_friction*v_load
    dx[1] = flow_orifice - alpha_cylinder*v_load
    dx[2] = alpha_cylinder*dp_chamber - F_stop - F_friction + F
    dx[3] = v_load
    dx[4] = (heat_orifice + heat_friction)/T + lam*(T_e/T - 1.0)
    return dx
end
