# Piezoelectric bender: two layers in opposition on one beam: irreversible port-Hamiltonian system.
#
# Source:  Smits, Dalke, Cooney (1991), Sensors and Actuators A 28, 41-61; PiezoDrive BA6020
# Model:   bimorph, spec sha256 e1bdc157e28404f3e3f2a5e6ecbc555574e7dfbd87761b8afc1f5ffdda416572
# System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
#          rows, multiplied out; `piezo-sym show` prints the matrices
# Proofs:  skew, casimir, welldef, temperature, energy, entropy, passive, odd, sigma, exergy, environment, units, program PROVED
#          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
#          parameters in the domain, and for banks of any size)
#
# Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
# Julia; values are in SI units.
#
# x = (x, p, S, Q_u, Q_l)
# u = (F, V_b, V, T_e)
# p_ = NamedTuple, with an underscore beside the model's own p

pow(x, w) = x^w
deadzone(z, w) = max(z - w, 0.0) + min(z + w, 0.0)
saturate(z, w) = clamp(z, -w, w)

const bimorph_parameters = (; l = 0.053, w = 0.02, h = 0.00026, s = 2.053e-11, d = 5.562e-10, eps = 4.056e-08, m = 0.001618, b = 0.02, R = 1000.0, T_0 = 293.15, c_0 = 2.0, lam = 0.02)

function bimorph_rhs!(dx, x_, u, p_)
    l = p_.l
    w = p_.w
    h = p_.h
    s = p_.s
    d = p_.d
    eps = p_.eps
    m = p_.m
    b = p_.b
    R = p_.R
    T_0 = p_.T_0
    c_0 = p_.c_0
    lam = p_.lam
    x = x_[1]
    p = x_[2]
    S = x_[3]
    Q_u = x_[4]
    Q_l = x_[5]
    F = u[1]
    V_b = u[2]
    V = u[3]
    T_e = u[4]
    F_bending = 2.0*w*h^3/(s*l^3)*x
    v_tip = p/m
    T = T_0*exp(S/c_0)
    V_Q_u = h/(4.0*w*l)*(2.0*(Q_u + Q_l)/eps + 2.0*(Q_u - Q_l)/(eps - 13.0*d^2/(16.0*s)))
    V_Q_l = h/(4.0*w*l)*(2.0*(Q_u + Q_l)/eps - 2.0*(Q_u - Q_l)/(eps - 13.0*d^2/(16.0*s)))
    alpha_upper = 3.0*w*h*d/(4.0*s*l)
    alpha_lower = 3.0*w*h*d/(4.0*s*l)
    V_output = -V_Q_u - V_Q_l + V_b
    i_output = V_output/R
    V_input = -V_Q_l + V
    i_input = V_input/R
    F_losses = b*v_tip
    heat_output = i_output*V_output
    heat_input = i_input*V_input
    heat_losses = F_losses*v_tip
    dx[1] = v_tip
    dx[2] = alpha_upper*V_Q_u - F_bending - alpha_lower*V_Q_l - F_losses + F
    dx[3] = (heat_output + heat_input + heat_losses)/T + lam*(T_e/T - 1.0)
    dx[4] = i_output - alpha_upper*v_tip
    dx[5] = alpha_lower*v_tip + i_output + i_input
    return dx
end
