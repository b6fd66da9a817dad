"""Faults in the network's laws and in the system made of them."""

from tests.mutants.mutant import mutants_of
from tests.mutants.specs import spec_of

MUTANTS = mutants_of(
    r"""
## network/kirchhoff
a transducer pushes the other way
  - return _across(port.second, ratio), _across(port.first, -ratio)
  + return _across(port.second, -ratio), _across(port.first, ratio)
  = transducer_between_moving_nodes
a transducer has another ratio
  - return _across(port.second, ratio), _across(port.first, -ratio)
  + return _across(port.second, self.field.one), _across(port.first, -self.field.one)
  = transducer_between_moving_nodes
a transducer's square
  - return _across(port.second, ratio), _across(port.first, -ratio)
  + return _across(port.second, ratio*ratio), _across(port.first, -ratio*ratio)
  = transducer_between_moving_nodes
the through variable of a coupling is doubled
  - _book(rows, port.first, Equation(first, {}), self.field.one)
  -                 _book(rows, port.second, Equation(second, {}), self.field.one)
  + _book(rows, port.first, Equation(first, {}), 2*self.field.one)
  +                 _book(rows, port.second, Equation(second, {}), 2*self.field.one)
  = transducer_between_moving_nodes
a coupling is left out
  - for port, ratio in self.ratio.items():
  -                 first, second
  + for port, ratio in list(self.ratio.items())[1:]:
  +                 first, second
  = transducer_between_moving_nodes
## network/junction
conduction leaves the second body
  - n: p.first for
  + n: p.second for
  = two airs
heat comes to another body
  - n: p.body for
  + n: next(e for e in ("body", "hot") if e in self.rows) for
  = two airs
resistors in a loop push the other way
  - J0=J0 - loops.between(B, B),
  + J0=J0 + loops.between(B, B),
  = coil loop
resistors in a loop do not change J0
  - J0=J0 - loops.between(B, B),
  + J0=J0,
  = coil loop
a source does not see a loop
  - g=self._with_entropies(g - loops.between(B, D), self.warmed),
  + g=self._with_entropies(g, self.warmed),
  = driven coil loop
a source sees a loop from the other side
  - g=self._with_entropies(g - loops.between(B, D), self.warmed),
  + g=self._with_entropies(g + loops.between(B, D), self.warmed),
  = driven coil loop
ports see a loop from the other side
  - N=N + loops.between(D, D),
  + N=N - loops.between(D, D),
  = driven coil loop
shares are left out of the processes' columns
  - B, D = loops.columns(B), loops.columns(D)
  + loops.columns(B), loops.columns(D)
  = coil loop
shares are left out of what drives processes
  - B, D = loops.columns(B), loops.columns(D)
  + B, D = loops.columns(B), D
  = driven coil loop
no heat is exchanged
  - if isinstance(p, Exchange | HeatInput)
  + if False
  = two airs
states are coupled the other way
  - J0, N = self._block("E", "E"), self._block("u", "u")
  + J0, N = self._block("E", "E").T, self._block("u", "u")
  = springs_in_a_loop
states are not coupled
  - J0, N = self._block("E", "E"), self._block("u", "u")
  + J0, N = self._block("E", "E") - self._block("E", "E"), self._block("u", "u")
  = springs_in_a_loop
## network/inverse
a law turned round multiplies by its slope
  - return div(top, slope)
  + return mul(slope, top)
  = affine linear
a law of one over R turned round divides
  - return mul(right, top)
  + return div(top, right)
  = output_resistance_of_a_bank
a law with a jump is linear
  - if any(letter in names(node) for node in walk(law) if isinstance(node, Call | Cmp)):
  + if False:
  = friction
a law that is not zero at zero is linear
  - return slope if slope is not None and vanishes(at_zero) else None
  + return slope
  = affine
## network/joints
rests of joined springs are subtracted
  - y.append(add(Sym(member.store.state), neg(rest)))
  + y.append(add(Sym(member.store.state), rest))
  = rigid_couplings
joined springs rest where the first does
  - rest = add(*(mul(other.shares[n], other.rest) for other in joint.members))
  + rest = member.rest
  = rigid_couplings
what follows adds no inertia
  - Z.T * sp.diag(*sizes) * Z
  + sp.diag(*sizes[: Z.cols])
  = rigid_couplings
joined states do not see each other
  - Z.T * sp.diag(*sizes) * Z
  + sp.diag(*(Z.T * sp.diag(*sizes) * Z).diagonal())
  = rigid_couplings
## network/loops
a loop is solved with the other sign
  - -e * slopes[c] for (r, c), e, _
  + e * slopes[c] for (r, c), e, _
  = coil loop
the skew part of a loop has the other sign
  - slopes[r] * entry * slopes[c] for
  + -slopes[r] * entry * slopes[c] for
  = coil loop
shares are transposed
  - return K @ self.H.T
  + return K @ self.H
  = coil loop
a loop's slope is that of its first resistor
  - law = slope_of(port.law, port.letter)
  + law = slope_of(members[0][1].law, members[0][1].letter)
  = loop
what a loop divides by is forgotten
  - divisors.append(divisor)
  + divisors.append(sp.S.One)
  = loop of any sign
## network/nodes
a node may be of two domains
  - if first != domain:
  + if domain is None:
  = two domains
a branch may have one node
  - if branch[0] == branch[1]:
  + if element == branch[0] == branch[1]:
  = shorted
## iphs/definitions
conduction heats the first body
  - return port.heats if isinstance(port, DissipativePort) else port.second
  + return port.heats if isinstance(port, DissipativePort) else port.first
  = two airs
heat flows to the warmer side of an exchange
  - return symbols.law(port.conductance, {}) * (ratio - 1)
  + return symbols.law(port.conductance, {}) * (1 - ratio)
  = two airs
an exchange is of the inverse temperatures
  - ratio = symbols[port.input] / temperature
  + ratio = temperature / symbols[port.input]
  = two airs
an exchange has another body's temperature
  - temperature = symbols[circuit.bodies[port.body].temperature]
  -     ratio
  + temperature = symbols[next(iter(circuit.of(Body)))[1].temperature]
  +     ratio
  = two airs
laws are of minus their letter
  - symbols.law(port.law, letters)
  + symbols.law(port.law, {port.letter: -z})
  = output_resistance
laws have another body's temperature
  - symbols.law(port.law, letters)
  + symbols.law(
  +                 port.law,
  +                 {
  +                     port.letter: z,
  +                     **{
  +                         body.temperature: symbols[next(iter(circuit.of(Body)))[1].temperature]
  +                         for _, body in circuit.of(Body)
  +                     },
  +                 },
  +             )
  = across
conduction is not over the first temperature
  - yield symbols[port.output], symbols.law(port.conductance, {}) * z / first
  + yield symbols[port.output], symbols.law(port.conductance, {}) * z
  = two airs
ratios have twice the temperature
  - yield symbols[port.name], symbols.law(port.ratio, {})
  + heat = [p.temperature for _, p in circuit.of(Body)]
  +         twice = {name: 2 * symbols[name] for name in heat}
  +         yield symbols[port.name], symbols.law(port.ratio, twice)
  = transducer_between_moving_nodes
co-states are merged
  - costates = {n: symbols[costate_name(port)] for n, (_, port) in enumerate(stores)}
  + costates = {n: symbols[costate_name(stores[n * (n != 1)][1])] for n, _ in enumerate(stores)}
  = two_sources_on_one_input
outputs are merged
  - outputs = {n: symbols[port.output] for n, port in enumerate(processes)}
  + outputs = {n: symbols[processes[0].output] for n, port in enumerate(processes)}
  = two_sources_on_one_input
inputs are merged
  - return symbols[port.input]
  -     temperature
  + return symbols[next(iter(circuit.model.inputs))]
  +     temperature
  = piezo
## iphs/system
a process is not over its temperature
  - entries = {k: w / self.E[self.heats[k], 0] for k, w in enumerate(self.W)}
  + entries = dict(enumerate(self.W))
  = two_sources_on_one_input
a process is over the first temperature
  - entries = {k: w / self.E[self.heats[k], 0] for k, w in enumerate(self.W)}
  + entries = {k: w / self.E[max(self.heats), 0] for k, w in enumerate(self.W)}
  = two_sources_on_one_input
what inputs add to a force has the other sign
  - return self.bracket + self.D.T @ self.u
  + return self.bracket - self.D.T @ self.u
  = across
forces have no input
  - return self.bracket + self.D.T @ self.u
  + return self.bracket
  = across
a body's own temperature is not taken
  - return self.B.T @ self.E - vector(self.processes, self.E.lanes, taken)
  + return self.B.T @ self.E
  = a1_two_bodies
processes cool what they heat
  - return self.J0 + couplings.T - couplings
  + return self.J0 - couplings.T + couplings
  = two_sources_on_one_input
processes are conservative
  - return self.J0 + couplings.T - couplings
  + return self.J0
  = two_sources_on_one_input
heat of a source stays away
  - return self.G + (self.D @ self._heating).T
  + return self.G
  = across
heat of a source is taken away
  - return self.G + (self.D @ self._heating).T
  + return self.G - (self.D @ self._heating).T
  = across
inputs push the other way
  - return self.J_ir @ self.E + self.g @ self.u
  + return self.J_ir @ self.E - self.g @ self.u
  = output_resistance
inputs do not push
  - return self.J_ir @ self.E + self.g @ self.u
  + return self.J_ir @ self.E
  = output_resistance
rates are of J0 alone
  - return self.J_ir @ self.E + self.g @ self.u
  + return self.J0 @ self.E + self.g @ self.u
  = output_resistance
outputs have the other sign
  - return self.g.T @ self.E + self.N @ self.u
  + return -self.g.T @ self.E + self.N @ self.u
  = output_resistance
outputs do not see other inputs
  - return self.g.T @ self.E + self.N @ self.u
  + return self.g.T @ self.E
  = ports
the production has no inputs
  - return (self.R.T @ self.z)[0, 0]
  + return (self.R.T @ self.bracket)[0, 0]
  = across
each process heats the next state
  - entries = {(k, self.heats[k]): r for k, r in enumerate(self.R) if r != 0}
  + entries = {(k, self.heats[k] - 1): r for k, r in enumerate(self.R) if r != 0}
  = two_sources_on_one_input
## iphs/iphs
slopes are those of one law
  - (slope.symbol, symbols.law(slope.law, {}))
  + (slope.symbol, symbols.law(junction.slopes[0].law, {}))
  = coil loop
co-states are of minus their state
  - symbols[costate_name(port)], symbols.law(port.law, {})
  + symbols[costate_name(port)], symbols.law(port.law, {port.state: -symbols[port.state]})
  = current
energies are another state's
  - energies=energies_of(circuit),
  + energies=energies_of(circuit)[:1] * len(system.states),
  = two_sources_on_one_input
the last energy is not counted
  - return sp.Add(*self._stored)
  + return sp.Add(*self._stored[:-1])
  = current
""",
    spec_of,
)
