; A point on its side of a wall's line, rho away from it, is rho away from the wall.
;
; The wall is a segment with ends v and w on the line n . q = b, n of unit length; the point p
; satisfies n . p <= b - rho. A place on the wall is v + t (w - v), 0 <= t <= 1.
;
; Lemma: |p - (v + t (w - v))|^2 >= rho^2. While p moves on a segment that starts and ends on its
; side, half-planes-moving.smt2 keeps it there.
(set-logic QF_NRA)
(declare-const nx Real)
(declare-const ny Real)
(declare-const b Real)
(declare-const rho Real)
(declare-const px Real)
(declare-const py Real)
; The place on the wall: it lies on the line because both ends do.
(declare-const qx Real)
(declare-const qy Real)
(assert (= (+ (* nx nx) (* ny ny)) 1))
(assert (> rho 0))
(assert (= (+ (* nx qx) (* ny qy)) b))
(assert (<= (+ (* nx px) (* ny py)) (- b rho)))
(check-sat) ; expect sat
(assert (< (+ (* (- px qx) (- px qx)) (* (- py qy) (- py qy))) (* rho rho)))
(check-sat) ; expect unsat
