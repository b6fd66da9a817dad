# DC motor with gear, bearing, and a winding that warms: irreversible port-Hamiltonian system.
#
# Source:  Messner, Tilbury, Control Tutorials for MATLAB and Simulink: DC motor speed, with gear and heat
# Model:   dc_motor, spec sha256 96a82a6d03ed86fc2c97e6ac88a26dd86ab244ed2d6fd71b14db35164a855b91
# System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
#          rows, multiplied out; `piezo-sym show` prints the matrices
# Proofs:  skew, casimir, temperature, welldef, energy, entropy, passive, odd, sigma, exergy, environment, units, program PROVED
#          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
#          parameters in the domain, and for banks of any size)
#
# Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
# Julia; values are in SI units.
#
# x = (phi, H, S)
# u = (V_in, tau, T_e)
# p = NamedTuple

pow(x, w) = x^w
deadzone(z, w) = max(z - w, 0.0) + min(z + w, 0.0)
saturate(z, w) = clamp(z, -w, w)

const dc_motor_parameters = (; R_0 = 1.0, al = 0.00393, L = 0.5, K = 0.01, J_m = 0.01, b = 0.1, n = 5.0, J_l = 0.25, c = 50.0, lam = 0.2, T_0 = 293.15)

function dc_motor_rhs!(dx, x, u, p)
    R_0 = p.R_0
    al = p.al
    L = p.L
    K = p.K
    J_m = p.J_m
    b = p.b
    n = p.n
    J_l = p.J_l
    c = p.c
    lam = p.lam
    T_0 = p.T_0
    phi = x[1]
    H = x[2]
    S = x[3]
    V_in = u[1]
    tau = u[2]
    T_e = u[3]
    i_armature = phi/L
    omega_rotor = H/(J_m + J_l/n^2)
    T_minus_T_0 = T_0*expm1(S/c)
    T = T_0 + T_minus_T_0
    n_machine = K
    n_gear = n
    V_winding = R_0*(1.0 + al*T_minus_T_0)*i_armature
    tau_bearing = b*omega_rotor
    heat_winding = V_winding*i_armature
    heat_bearing = tau_bearing*omega_rotor
    dx[1] = V_in - n_machine*omega_rotor - V_winding
    dx[2] = n_machine*i_armature - tau_bearing + tau/n_gear
    dx[3] = (heat_winding + heat_bearing)/T + lam*(T_e/T - 1.0)
    return dx
end
