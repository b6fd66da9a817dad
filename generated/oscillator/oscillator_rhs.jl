# Damped oscillator that heats itself: irreversible port-Hamiltonian system.
#
# Source:  Ramirez, Maschke, Sbarbaro (2013), Eur. J. Control 19, 513-520, the mass-spring-damper
# Model:   oscillator, spec sha256 98f74415ae4d927ffd7693687e1755d27c6ee4baa18ca60809e3c3d10d605268
# System:  dx/dt = J_ir dU/dx + g u, J_ir = J0 + sum_k R_k J_k over processes k; here are its
#          rows, multiplied out; `piezo-sym show` prints the matrices
# Proofs:  skew, casimir, temperature, energy, entropy, welldef, passive, odd, sigma, units, program PROVED
#          (rows of `piezo-sym verify`; what is PROVED holds for all states, inputs and
#          parameters in the domain, and for banks of any size)
#
# Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
# Julia; values are in SI units.
#
# x = (q, p, S)
# u = (F)
# p_ = NamedTuple, with an underscore beside the model's own p

pow(x, w) = x^w
deadzone(z, w) = max(z - w, 0.0) + min(z + w, 0.0)
saturate(z, w) = clamp(z, -w, w)

const oscillator_parameters = (; m = 1.0, k = 4.0, d = 0.4, T_0 = 300.0, c = 2.0)

function oscillator_rhs!(dx, x, u, p_)
    m = p_.m
    k = p_.k
    d = p_.d
    T_0 = p_.T_0
    c = p_.c
    q = x[1]
    p = x[2]
    S = x[3]
    F = u[1]
    F_spring = k*q
    v_mass = p/m
    T = T_0*exp(S/c)
    F_damper = d*v_mass
    heat_damper = F_damper*v_mass
    dx[1] = v_mass
    dx[2] = F - F_spring - F_damper
    dx[3] = heat_damper/T
    return dx
end
