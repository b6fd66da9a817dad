# Peltier cooler: cold plate, thermoelectric couples, heat sink: irreversible port-Hamiltonian system.
#
# Source:  Ioffe (1957), Semiconductor Thermoelements; values of a module of 127 couples
# Model:   peltier_cooler, spec sha256 e97f90f757f77de747011f7a983b38c3f53075a795fa19e001fa2cd5567cc5f1
# System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
#          rows, multiplied out; `piezo-sym show` prints the matrices
# Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, exergy, environment, units, program PROVED
#          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
#          parameters in the domain, and for banks of any size)
#
# Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
# Julia; values are in SI units.
#
# x = (phi, S_c, S_h)
# u = (V_in, P, T_e)
# p = NamedTuple

pow(x, w) = x^w
deadzone(z, w) = max(z - w, 0.0) + min(z + w, 0.0)
saturate(z, w) = clamp(z, -w, w)

const peltier_cooler_parameters = (; s = 0.05, R = 2.0, lam = 0.5, L = 0.001, c_c = 20.0, c_h = 200.0, h = 50.0, T_0 = 300.0)

function peltier_cooler_rhs!(dx, x, u, p)
    s = p.s
    R = p.R
    lam = p.lam
    L = p.L
    c_c = p.c_c
    c_h = p.c_h
    h = p.h
    T_0 = p.T_0
    phi = x[1]
    S_c = x[2]
    S_h = x[3]
    V_in = u[1]
    P = u[2]
    T_e = u[3]
    i_leads = phi/L
    T_plate = T_0*exp(S_c/c_c)
    T_sink = T_0*exp(S_h/c_h)
    seebeck_couples = s
    V_warm = R/2.0*i_leads
    V_cool = R/2.0*i_leads
    s_legs = lam*(T_plate - T_sink)/T_plate
    heat_warm = V_warm*i_leads
    heat_cool = V_cool*i_leads
    heat_legs = s_legs*T_plate
    dx[1] = seebeck_couples*T_plate - seebeck_couples*T_sink - V_warm - V_cool + V_in
    dx[2] = heat_cool/T_plate - seebeck_couples*i_leads - s_legs + P/T_plate
    dx[3] = (heat_warm + heat_legs)/T_sink + seebeck_couples*i_leads + h*(T_e/T_sink - 1.0)
    return dx
end
