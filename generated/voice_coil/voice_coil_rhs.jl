# Voice coil of a loudspeaker, with the heat of its winding: irreversible port-Hamiltonian system.
#
# Source:  Small (1972), J. Audio Eng. Soc. 20 (5), 383-395; values of a 165 mm driver
# Model:   voice_coil, spec sha256 b17a1309ca30712ebd0993cb3dcdd961cc3539b78aa3f80bce5bbdfa54c8bfcf
# System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
#          rows, multiplied out; `piezo-sym show` prints the matrices
# Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
#          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
#          parameters in the domain, and for banks of any size)
#
# Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
# Julia; values are in SI units.
#
# x = (q, p, phi, S_w, S_m)
# u = (V_in, T_e)
# p_ = NamedTuple, with an underscore beside the model's own p

pow(x, w) = x^w
deadzone(z, w) = max(z - w, 0.0) + min(z + w, 0.0)
saturate(z, w) = clamp(z, -w, w)

const voice_coil_parameters = (; m = 0.014, k = 1100.0, d = 1.2, Bl = 6.5, R_0 = 5.6, al = 0.00393, L = 0.0005, c_w = 4.0, c_m = 400.0, lam = 0.4, h = 0.5, T_0 = 293.15)

function voice_coil_rhs!(dx, x, u, p_)
    m = p_.m
    k = p_.k
    d = p_.d
    Bl = p_.Bl
    R_0 = p_.R_0
    al = p_.al
    L = p_.L
    c_w = p_.c_w
    c_m = p_.c_m
    lam = p_.lam
    h = p_.h
    T_0 = p_.T_0
    q = x[1]
    p = x[2]
    phi = x[3]
    S_w = x[4]
    S_m = x[5]
    V_in = u[1]
    T_e = u[2]
    F_suspension = k*q
    v_cone = p/m
    i_coil = phi/L
    T_winding_minus_T_0 = T_0*expm1(S_w/c_w)
    T_winding = T_0 + T_winding_minus_T_0
    T_magnet = T_0*exp(S_m/c_m)
    n_gap = Bl
    F_losses = d*v_cone
    V_copper = R_0*(1.0 + al*T_winding_minus_T_0)*i_coil
    s_contact = lam*(T_winding - T_magnet)/T_winding
    heat_losses = F_losses*v_cone
    heat_copper = V_copper*i_coil
    heat_contact = s_contact*T_winding
    dx[1] = v_cone
    dx[2] = n_gap*i_coil - F_suspension - F_losses
    dx[3] = V_in - n_gap*v_cone - V_copper
    dx[4] = heat_copper/T_winding - s_contact
    dx[5] = (heat_losses + heat_contact)/T_magnet + h*(T_e/T_magnet - 1.0)
    return dx
end
