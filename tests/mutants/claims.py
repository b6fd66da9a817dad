"""Faults in what is asked of laws, and in what is made of answers."""

from tests.mutants.mutant import mutants_of
from tests.mutants.specs import spec_of

MUTANTS = mutants_of(
    r"""
## proofs/domain
whether the domain has values is not asked
  - obligation = obligation.asking(questions, "a condition of the domain")
  + obligation = obligation.asking(tuple, "a condition of the domain")
  = d*v | d > 0; sqrt(a/d) >= 0 | a=1.0
## proofs/continuity
branches never meet
  - opposite(condition) in other.conditions and {*names(condition)} <= assumptions.fixed
  + opposite(condition) in other.conditions
  = d*v if v < v_1 else 2*d*v | d > 0; v_1 > 0
each branch agrees with itself
  - claim = Cmp("=", one.value, other.value)
  + claim = Cmp("=", one.value, one.value)
  = d*v if v < v_1 else 2*d*v | d > 0; v_1 > 0
no edge is one of states
  - if not law.jumps and _edges(law, assumptions)]
  + if not law.jumps and not _edges(law, assumptions)]
  = d*v if v < v_1 else 2*d*v | d > 0; v_1 > 0
only the first two branches meet
  - combinations(found, 2)
  + combinations(found[:2], 2)
  = d*v if v < v_1 else (d*v_1 if v < 2*v_1 else d*v) | d > 0; v_1 > 0
branches meet where a side is zero
  - yield Cmp("=", condition.left, condition.right)
  + yield Cmp("=", condition.left, add(condition.left, neg(condition.left)))
  = d*v if v < v_1 else 2*d*v | d > 0; v_1 > 0
edges of parameters are all
  - if not {*names(c)} <= assumptions.fixed]
  + if {*names(c)} <= assumptions.fixed]
  = d*v if v < v_1 else 2*d*v | d > 0; v_1 > 0
no branch is ever taken
  - return solver.ask(asked.query).result == "unsat"
  + return solver.ask(asked.query).result != "unsat"
  = d*v if v < v_1 else 2*d*v | d > 0; v_1 > 0
any third branch lies in between
  - paths[third] <= both
  + paths[third] & both
  = d*v if v < v_1 else (2*d*v if v < 2*v_1 else 4*d*v_1) | d > 0; v_1 > 0
## proofs/laws
the law, not its power
  - mul(branch.value, Sym(letter)) if letter else branch.value,
  + branch.value,
  = F_1 | F_1 > 0
a branch has nothing to show
  - if not (plain and branch.value == ZERO)
  + if not plain
  = a*v
only the first branch is asked about
  - return (*found, question.covered(pieces)) if len(pieces) > 1 else tuple(found)
  + return tuple(found[:1])
  = d*v if b > a_1 else a*v | d > 0; a_1 > 0
conduction has nothing to show
  - (*value_questions(law.tree, assumptions), *branch_questions(law.tree, question))
  + value_questions(law.tree, assumptions)
  = conduction
a law has a value everywhere
  - return obligation if needed else None
  + return replace(obligation, questions=()) if needed else None
  = d*v*a_1**2/a**2 | d > 0; a_1 > 0
conditions have values everywhere
  - for part in (*branch.conditions, branch.value):
  + for part in (branch.value,):
  = d*v if a_1/a > 1 else 2*d*v | d > 0; a_1 > 0
what is asked is assumed
  - Question(label, assumptions.order, where, claim, claim, branch, law=law)
  + Question(label, assumptions.order, (*where, claim), claim, claim, branch, law=law)
  = d*v*a_1**2/a**2 | d > 0; a_1 > 0
every law is odd
  - total = ZERO if twice == neg(turned) else add(twice, turned)
  + total = ZERO
  = d*v + d*v**2/v_1 if v > 0 else d*v | d > 0; v_1 > 0
every law has the first body's temperature
  - return Law(element, port.output, port.law, port.letter
  + hot = [Sym(body.temperature) for _, body in iphs.circuit.of(Body)]
  +             law = substituted(port.law, {T.name: hot[0] for T in hot})
  +             return Law(element, port.output, law, port.letter
  = two bodies
## proofs/assumptions
an element turned round has its state's sign
  - coefficient(drive)
  + coefficient(-drive)
  = turned
letters are tied to each other's states
  - in zip(processes, iphs.system.drive, strict=True)
  + in zip(processes, tuple(iphs.system.drive)[::-1], strict=True)
  = two masses
## proofs/obligations
of a claim's branches the first is asked about
  - for branch in found
  -             ),
  + for branch in found[:1]
  +             ),
  = exchange
every branch of a claim says what the first does
  - where=(*self.where, *branch.conditions),
  -                     claim=Cmp(self.claim.op, *parts(branch)),
  + where=(*self.where, *branch.conditions),
  +                     claim=Cmp(self.claim.op, *parts(found[0])),
  = exchange
what may be zero is not
  - case Cmp("<" | ">", Sym(name), Num(value)) if value == 0:
  + case Cmp(_, Sym(name), Num(value)) if value == 0:
  = d*v*a_1**2/a**2 | d > 0; a_1 > 0; a >= 0; (a_1/a if a > 0 else 1) > 0 | a=1.0
## proofs/balances
the second law rests on no law
  - return (*bodies, *laws)
  + return (*bodies,)
  = d*v if b > a_1 else a*v | d > 0; a_1 > 0
heat exchange has nothing to show
  - yield assumptions.question(label, conducts)
  + yield assumptions.question(label, warm)
  = cold
## proofs/prove
questions left open are forgotten
  - left += [found] if found else []
  + left += []
  = F_1*(v/v_1)*(exp(v/v_1 + b/a_1 - 0.37) - 2.718281*(v/v_1 + b/a_1 - 0.37)) | F_1 > 0; v_1 > 0;
  = a_1 > 0; b > 0 | b=0.37
what is open is no obstacle
  - if verdict is not Verdict.PROVED:
  + if verdict is Verdict.REFUTED:
  = F_1*(v/v_1)*(exp(v/v_1 + b/a_1 - 0.37) - 2.718281*(v/v_1 + b/a_1 - 0.37)) | F_1 > 0; v_1 > 0;
  = a_1 > 0; b > 0 | b=0.37
a sign left open is shown
  - return Finding(Verdict.OPEN, None, f"{obligation.statement}: {found.reason}"), ()
  + return None, ()
  = F_1*(v/v_1)*(exp(v/v_1 + b/a_1 - 0.37) - 2.718281*(v/v_1 + b/a_1 - 0.37)) | F_1 > 0; v_1 > 0;
  = a_1 > 0; b > 0 | b=0.37
a refuted question is left open, and forgotten
  - if found and found.verdict is Verdict.REFUTED:
  -             return found
  -         left += [found] if found else []
  + if found and found.verdict is Verdict.REFUTED:
  +             continue
  +         left += [found] if found else []
  = a*v
a model that breaks the claim is a proof
  - answer = solver.ask(replace(question, keep_all=True).query)
  -         if answer.result == "unsat":
  + answer = solver.ask(replace(question, keep_all=True).query)
  +         if answer.result == "sat":
  = a*v
## proofs/refutation
an answer that bounds do not decide is a proof
  - return Finding(Verdict.OPEN, None, reason, _remedy(question.law, values))
  + return Finding(Verdict.PROVED)
  = F_1*(v/v_1)*(exp(v/v_1 + b/a_1 - 0.37) - 2.718281*(v/v_1 + b/a_1 - 0.37)) | F_1 > 0; v_1 > 0;
  = a_1 > 0; b > 0 | b=0.37
## proofs/asked
of a claim's parts one is enough
  - return all(answer.result == "unsat" for answer in self._answers(claim, claim))
  + return any(answer.result == "unsat" for answer in self._answers(claim, claim))
  = min(a + 5*a_1, d)*v*(exp(v/v_1) - 7.38*(v/v_1 - 1)) | d > 0; a_1 > 0; v_1 > 0 | a=-6.0
a sum is positive by one term
  - case Add(terms) if all(map(self.nonnegative, terms)) and any(map(self.positive, terms)):
  + case Add(terms) if any(map(self.positive, terms)):
  = F_1*(v/(v_1 - v_2/1000)*(exp(v/(v_1 - v_2/1000)) - 7.38*(v/(v_1 - v_2/1000) - 1))) | F_1 >
  = 0; v_1 > 0; v_2 > 0;
  = (v_1 - v_2/1000)**2 > 0 | v_2=2000.0
a name in the domain is positive
  - case Sym() if Cmp(">", part, ZERO) in map(greater, self.where):
  + case Sym() if any(part in (c.left, c.right) for c in self.where):
  = F_1*(v*a/F_1*(exp(v*a/F_1) - 7.38*(v*a/F_1 - 1))) | F_1 > 0; a_1 > 0; a < 3*a_1
every power keeps its sign
  - return e.denominator != 1 or e % 2 == 0 or self.nonnegative(base)
  + return True
  = a**3/a_1**2*v*(exp(v/v_1) - 7.38*(v/v_1 - 1)) | v_1 > 0; a_1 > 0
a sum keeps its sign by one term
  - return all(map(self.nonnegative, parts))
  + return any(map(self.nonnegative, parts))
  = (F_1 - F_2/1000)*(v/v_1*(exp(v/v_1) - 7.38*(v/v_1 - 1))) | F_1 > 0; F_2 > 0; v_1 > 0 |
  = F_2=2000.0
a product keeps its sign by one factor
  - return self.nonnegative(left) and self.nonnegative(right)
  + return self.nonnegative(left) or self.nonnegative(right)
  = (a*d + d**2)/d*v*(exp(v/v_1) - 7.38*(v/v_1 - 1)) | d > 0; v_1 > 0 | a=-5.0
a name keeps its sign
  - return self.positive(part)
  -             case Call(
  + return True
  +             case Call(
  = a*v*(exp(v/v_1) - 7.38*(v/v_1 - 1)) | v_1 > 0
tanh is never below zero
  - if RECORDS[function].sign:
  + if RECORDS[function].sign or function == "tanh":
  = F_1*tanh(1000 - exp(b/a_1))*(v/v_1*(exp(v/v_1) - 7.38*(v/v_1 - 1))) | F_1 > 0; a_1 > 0; v_1
  = > 0; b > 0
  = | b=7.0
what is known of one case is known of all
  - return replace(self, where=(*self.where, *guards), known={})
  + return replace(self, where=(*self.where, *guards))
  = F_1*(v*(a + 1000*a_1)/F_1*(exp(v*(a + 1000*a_1)/F_1) - 7.38*(v*(a + 1000*a_1)/F_1 - 1))) if
  = a > 0 else
  = F_1*(v*(a + 1000*a_1)/F_1*(exp(v*(a + 1000*a_1)/F_1) - 7.38*(v*(a + 1000*a_1)/F_1 - 1)))/2 |
  = F_1 > 0; a_1 > 0 | a=-2000.0
## proofs/sign_analysis
a term that is not shown to be passive is left out
  - if part is None:
  -             return None
  -         found += part
  + found += part or ()
  = F_1*(log(1 + exp(v/v_1)) - log(2)) - F_2/1000*(log(1 + exp(v/v_2)) - log(2)) | F_1 > 0;
  = F_2 > 0; v_1 > 0; v_2 > 0 | F_2=4000.0
what is left open is shown
  - elif decision.verdict is not Verdict.PROVED:
  + elif decision.verdict is Verdict.REFUTED:
  = F_1*(v/v_1)*(exp((v/v_1)**2/2) - 2.71828182846*(v/v_1)**2/2) | F_1 > 0; v_1 > 0
a case that is not shown is empty
  - elif not search.domain.empty():
  + elif search.domain.empty():
  = F_1*(log(1 + exp(v/v_1)) - log(2)) if a > 0 else
  = F_1*(v/v_1)*(exp(v/v_1 - 0.37) - 2.7184*(v/v_1 - 0.37)) | F_1 > 0; v_1 > 0
every factor keeps its sign
  - if self.domain.follows(Cmp(">=", fold(mul, left, start), ZERO)):
  + if self.domain.follows(Cmp(">=", fold(mul, left, start), fold(mul, left, start))):
  = (1000*a_1 - a)*v*(exp(v/v_1) - 7.38*(v/v_1 - 1)) | a_1 > 0; v_1 > 0 | a=2000.0
a factor that keeps no sign is left out
  - total = -total if self._keeps([factor], -1) else 0
  + total = -total if self._keeps([factor], -1) else total
  = (1000*a_1 - a)*(b - a_1)/a_1*v*(exp(v/v_1) - 7.38*(v/v_1 - 1)) | a_1 > 0; v_1 > 0; b > a_1
  = | a=2000.0
a polynomial part is passive
  - if law == self.law or not self.domain.follows(Cmp(">=", power, ZERO)):
  + if law == self.law:
  = F_1*(log(1 + exp(v/v_1)) - log(2)) + min(a + 5*a_1, d)*v | F_1 > 0; a_1 > 0; v_1 > 0; d > 0
  = | a=-6.0
""",
    spec_of,
)
