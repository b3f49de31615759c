; The closest approach of two motions is where the monitor looks for it.
;
; The offset of two robots is d + s v, 0 <= s <= 1. `closest_approach` takes s0, the vertex
; -d . v / |v|^2 clamped to [0, 1].
;
; Lemma: |d + s0 v|^2 <= |d + s v|^2 for every s in [0, 1].
(set-logic QF_NRA)
(declare-const dv Real) ; d . v
(declare-const vv Real) ; |v|^2
(declare-const s Real)
(declare-const s0 Real)
(assert (> vv 0))
(assert (<= 0 s 1))
; s0 = clamp(-dv / vv, 0, 1), without a division.
(assert (or (and (= s0 0) (<= (- dv) 0))
            (and (= s0 1) (>= (- dv) vv))
            (and (= (* s0 vv) (- dv)) (<= 0 s0 1))))
(check-sat) ; expect sat
; |d + s v|^2 = |d|^2 + 2 s (d . v) + s^2 |v|^2; |d|^2 is the same on both sides.
(assert (> (+ (* 2 s0 dv) (* s0 s0 vv)) (+ (* 2 s dv) (* s s vv))))
(check-sat) ; expect unsat
