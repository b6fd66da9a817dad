; Made by piezo_sym 0.1.0; do not edit: change the spec, then run `piezo-sym generate`.
; Claims on the laws of oscillator.  Each query asserts the opposite of its claim:
; `unsat` proves it, for all real numbers in the domain.  A function such as exp is
; a symbol with bounds on its values.  Names begin with a question mark.
(set-logic QF_NRA)

; temperature of body: c != 0
(push 1)
(declare-const ?c Real)
(assert (> ?c 0))
(assert (not (not (= ?c 0))))
(check-sat)
(pop 1)

; temperature of body: c != 0
(push 1)
(declare-const ?c Real)
(assert (> ?c 0))
(assert (not (= ?c 0)))
(assert (not (not (= ?c 0))))
(check-sat)
(pop 1)

; temperature of body: T > 0
(push 1)
(declare-const ?T_0 Real)
(declare-const ?c Real)
(declare-const ?S Real)
(declare-const ?exp_1 Real)
(declare-const ?exp_argument_1 Real)
(assert (> ?T_0 0))
(assert (> ?c 0))
(assert (not (= ?c 0)))
(assert (= (* ?exp_argument_1 ?c) ?S))
(assert (> ?exp_1 0))
(assert (>= ?exp_1 (+ 1 ?exp_argument_1)))
(assert (>= ?exp_1 (* (/ 67957 25000) ?exp_argument_1)))
(assert (or (< ?exp_argument_1 0) (>= ?exp_1 (+ 1 ?exp_argument_1 (* (/ 1 2) (* ?exp_argument_1 ?exp_argument_1))))))
(assert (or (>= ?exp_argument_1 1) (<= (* ?exp_1 (+ 1 (- ?exp_argument_1))) 1)))
(assert (not (> (* ?T_0 ?exp_1) 0)))
(check-sat)
(pop 1)

; temperature of body: dT/dS > 0
(push 1)
(declare-const ?T_0 Real)
(declare-const ?c Real)
(declare-const ?S Real)
(declare-const ?exp_1 Real)
(declare-const ?exp_argument_1 Real)
(assert (> ?T_0 0))
(assert (> ?c 0))
(assert (not (= ?c 0)))
(assert (= (* ?exp_argument_1 ?c) ?S))
(assert (> ?exp_1 0))
(assert (>= ?exp_1 (+ 1 ?exp_argument_1)))
(assert (>= ?exp_1 (* (/ 67957 25000) ?exp_argument_1)))
(assert (or (< ?exp_argument_1 0) (>= ?exp_1 (+ 1 ?exp_argument_1 (* (/ 1 2) (* ?exp_argument_1 ?exp_argument_1))))))
(assert (or (>= ?exp_argument_1 1) (<= (* ?exp_1 (+ 1 (- ?exp_argument_1))) 1)))
(assert (not (> (* ?T_0 ?exp_1 ?c) 0)))
(check-sat)
(pop 1)

; welldef of mass: m != 0
(push 1)
(declare-const ?m Real)
(assert (> ?m 0))
(assert (not (not (= ?m 0))))
(check-sat)
(pop 1)

; passive of damper: F_damper*v >= 0
(push 1)
(declare-const ?d Real)
(declare-const ?v Real)
(assert (>= ?d 0))
(assert (not (>= (* ?d ?v ?v) 0)))
(check-sat)
(pop 1)

; welldef of body: c != 0
(push 1)
(declare-const ?c Real)
(assert (> ?c 0))
(assert (not (not (= ?c 0))))
(check-sat)
(pop 1)
