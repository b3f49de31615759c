; A convex, nondecreasing function of a convex function is convex: the second half of the
; certified acceptance.
;
; c stands for the cost 1/R and d for the distance. At three choices of the shares travelled, two
; and one between (t in [0, 1]), the distances are d0, d1 and dt <= t d1 + (1 - t) d0
; (distance-convex.smt2). c does not decrease, and is convex, at the distances that matter: the
; three, and m = t d1 + (1 - t) d0.
;
; Lemma: c(dt) <= t c(d1) + (1 - t) c(d0).
(set-logic QF_UFNRA)
(declare-fun c (Real) Real)
(declare-const d0 Real)
(declare-const d1 Real)
(declare-const dt Real)
(declare-const m Real)
(declare-const t Real)
(assert (<= 0 t 1))
(assert (= m (+ (* t d1) (* (- 1 t) d0))))
(assert (<= 0 dt m))
(assert (<= (c dt) (c m)))
(assert (<= (c m) (+ (* t (c d1)) (* (- 1 t) (c d0)))))
(check-sat) ; expect sat
(assert (> (c dt) (+ (* t (c d1)) (* (- 1 t) (c d0)))))
(check-sat) ; expect unsat
