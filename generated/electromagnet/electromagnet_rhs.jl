# Electromagnet with an armature on a spring, and a coil that warms: irreversible port-Hamiltonian system.
#
# Source:  Woodson, Melcher (1968), Electromechanical Dynamics I, ch. 3
# Model:   electromagnet, spec sha256 9b4244be212754305b836d305b67a8844d9eaeab14c345563f9a22957982c0af
# System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
#          rows, multiplied out; `piezo-sym show` prints the matrices
# Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
#          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
#          parameters in the domain, and for banks of any size)
#
# Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
# Julia; values are in SI units.
#
# x = (q, p, S, phi, x)
# u = (V_in, T_e)
# p_ = NamedTuple, with an underscore beside the model's own p

pow(x, w) = x^w
deadzone(z, w) = max(z - w, 0.0) + min(z + w, 0.0)
saturate(z, w) = clamp(z, -w, w)

const electromagnet_parameters = (; g = 0.002, A = 0.0001, N = 500.0, mu = 1.25663706e-06, m = 0.05, k = 5000.0, d = 3.0, R = 8.0, c = 20.0, lam = 0.3, T_0 = 293.15)

function electromagnet_rhs!(dx, x_, u, p_)
    g = p_.g
    A = p_.A
    N = p_.N
    mu = p_.mu
    m = p_.m
    k = p_.k
    d = p_.d
    R = p_.R
    c = p_.c
    lam = p_.lam
    T_0 = p_.T_0
    q = x_[1]
    p = x_[2]
    S = x_[3]
    phi = x_[4]
    x = x_[5]
    V_in = u[1]
    T_e = u[2]
    F_spring = k*q
    v_armature = p/m
    T = T_0*exp(S/c)
    i_phi = 2.0*(phi*(g + x))/(2.0*mu*A*N^2)
    F_x = phi^2/(2.0*mu*A*N^2)
    V_copper = R*i_phi
    F_friction = d*v_armature
    heat_copper = V_copper*i_phi
    heat_friction = F_friction*v_armature
    dx[1] = v_armature
    dx[2] = -F_spring - F_x - F_friction
    dx[3] = (heat_copper + heat_friction)/T + lam*(T_e/T - 1.0)
    dx[4] = V_in - V_copper
    dx[5] = v_armature
    return dx
end
