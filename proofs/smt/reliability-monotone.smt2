; Eq. (27) is strictly monotone between its ends: a smaller part q of the transition left means a
; smaller R = q^2 (3 - 2 q).
(set-logic QF_NRA)
(declare-const p Real)
(declare-const q Real)
(define-fun R ((q Real)) Real (* q q (- 3 (* 2 q))))
(assert (and (<= 0 p) (< p q) (<= q 1)))
(check-sat) ; expect sat
(assert (<= (R q) (R p)))
(check-sat) ; expect unsat
