; A robot goes away from one that has stopped, wherever that may be.
;
; The second robot was heard last at the distance D in the direction (1, 0), and is at the offset (x, y) from
; the first, within u of where it was heard. They are 2 rho apart or more: T >= 2 rho. What holds for the
; direction of the offset holds if it holds within an angle of (1, 0) of which the cosine is
; (D² + W² - u²) / 2 D W, where W is the greater one of 2 rho and the root of D² - u² (Errors::half_planes_beside);
; that it need only be looked at for the outermost directions is lemma 3 of half-planes-errors.smt2.
(set-logic QF_NRA)
(declare-const rho Real)
(declare-const D Real)
(declare-const u Real)
(declare-const x Real)
(declare-const y Real)
(declare-const T Real)
(declare-const W Real)
(assert (and (> rho 0) (> D 0) (>= u 0) (>= T (* 2 rho)) (= (* T T) (+ (* x x) (* y y)))))
(assert (<= (+ (* (- x D) (- x D)) (* y y)) (* u u)))
(define-fun square () Real (- (* D D) (* u u)))
(define-fun is-outside () Bool (< (* 2 D W x) (* (+ square (* W W)) T)))
; Lemma 1: it may be as near as 2 rho.
(push)
(assert (and (= W (* 2 rho)) (<= square (* 4 rho rho))))
(check-sat) ; expect sat
(assert is-outside)
(check-sat) ; expect unsat
(pop)
; Lemma 2: it is farther away than that.
(push)
(assert (and (> W (* 2 rho)) (= (* W W) square)))
(check-sat) ; expect sat
(assert is-outside)
(check-sat) ; expect unsat
(pop)
; Lemma 3: a move that leads along the offset no farther leaves the distance at least as long, at each share s.
(declare-const v Real)
(declare-const w Real)
(declare-const s Real)
(assert (and (<= 0 s 1) (<= (+ (* x v) (* y w)) 0)))
(check-sat) ; expect sat
(assert (< (+ (* (- x (* s v)) (- x (* s v))) (* (- y (* s w)) (- y (* s w)))) (* T T)))
(check-sat) ; expect unsat
