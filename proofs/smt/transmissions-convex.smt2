; 1/R is convex in the distance where R > 0: the first half of the certified acceptance.
;
; With derivatives by s = 1 - q, R = q^2 (3 - 2 q), R' = -6 q (1 - q), R'' = 6 (1 - 2 q). Since
; (1/R)'' = (2 R'^2 - R R'') / R^3 and R > 0, convexity is
;
; Lemma: 2 R'^2 - R R'' > 0 for 0 < q <= 1.
;
; At q = 1 the slope of 1/R is 0, so that the constant 1 in front (d <= l) continues it convexly.
(set-logic QF_NRA)
(declare-const q Real)
(define-fun R () Real (* q q (- 3 (* 2 q))))
(define-fun slope () Real (* (- 6) q (- 1 q)))
(define-fun curvature () Real (* 6 (- 1 (* 2 q))))
(assert (and (< 0 q) (<= q 1)))
(check-sat) ; expect sat
(assert (<= (- (* 2 slope slope) (* R curvature)) 0))
(check-sat) ; expect unsat
