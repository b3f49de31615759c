; The slope 6 q (1 - q) is the derivative of R = q^2 (3 - 2 q).
;
; A polynomial of third degree differs from its tangent by a multiple of h^2:
; R(q + h) - R(q) - slope(q) h = h^2 (3 - 6 q - 2 h) for every q and h, so that the quotient of
; differences tends to the slope.
(set-logic QF_NRA)
(declare-const q Real)
(declare-const h Real)
(define-fun R ((q Real)) Real (* q q (- 3 (* 2 q))))
(define-fun slope ((q Real)) Real (* 6 q (- 1 q)))
(check-sat) ; expect sat
(assert (distinct (- (R (+ q h)) (R q) (* (slope q) h)) (* h h (- 3 (* 6 q) (* 2 h)))))
(check-sat) ; expect unsat
