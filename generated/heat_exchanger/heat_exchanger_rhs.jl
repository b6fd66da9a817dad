# Heat exchanger: two bodies in contact: irreversible port-Hamiltonian system.
#
# Source:  Ramirez, Maschke, Sbarbaro (2013), Chem. Eng. Sci. 89, 223-234, the heat exchanger
# Model:   heat_exchanger, spec sha256 81da265b96a9585ebb1056051f48674761b82597e707def9ebb654e693d5bec0
# System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
#          rows, multiplied out; `piezo-sym show` prints the matrices
# Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, sigma, units, program PROVED
#          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
#          parameters in the domain, and for banks of any size)
#
# Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
# Julia; values are in SI units.
#
# x = (S_hot, S_cold)
# u = ()
# p = NamedTuple

pow(x, w) = x^w
deadzone(z, w) = max(z - w, 0.0) + min(z + w, 0.0)
saturate(z, w) = clamp(z, -w, w)

const heat_exchanger_parameters = (; c_1 = 2.0, c_2 = 3.0, lam = 0.5, T_0 = 300.0, T_1 = 350.0, T_2 = 290.0)

function heat_exchanger_rhs!(dx, x, u, p)
    c_1 = p.c_1
    c_2 = p.c_2
    lam = p.lam
    T_0 = p.T_0
    S_hot = x[1]
    S_cold = x[2]
    T_hot = T_0*exp(S_hot/c_1)
    T_cold = T_0*exp(S_cold/c_2)
    s_contact = lam*(T_hot - T_cold)/T_hot
    heat_contact = s_contact*T_hot
    dx[1] = -s_contact
    dx[2] = heat_contact/T_cold
    return dx
end
