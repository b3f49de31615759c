; Robots whose places and moves have errors keep their distance.
;
; Two robots believe to be at the distance D from each other; the second lies in the direction x. Their
; true offset is off by at most 2e in that direction. The first moves by v and the second by w along x, each
; at its own pace: the shares s and t of the moves are done, and each strays by at most its share of m.
;
; Lemma 1: with D >= 2 rho + 2e and v, -w <= D/2 - (rho + e + m), or one or both staying, 2 rho is left
; between them.
(set-logic QF_NRA)
(declare-const rho Real)
(declare-const e Real)
(declare-const m Real)
(declare-const distance Real)
(declare-const offset Real)
(declare-const v Real)
(declare-const w Real)
(declare-const s Real)
(declare-const t Real)
(declare-const stray Real)
(declare-const other Real)
(assert (and (> rho 0) (<= 0 e) (<= 0 m) (<= 0 s 1) (<= 0 t 1)))
(assert (<= (* (- 1) s m) stray (* s m)))
(assert (<= (* (- 1) t m) other (* t m)))
(push)
(assert (>= offset (- distance (* 2 e))))
(assert (>= distance (+ (* 2 rho) (* 2 e))))
(assert (or (= s 0) (<= v (- (/ distance 2) (+ rho e m)))))
(assert (or (= t 0) (<= (- w) (- (/ distance 2) (+ rho e m)))))
(check-sat) ; expect sat
(assert (< (+ (- offset (* s v) stray) (* t w) other) (* 2 rho)))
(check-sat) ; expect unsat
(pop)
;
; Lemma 2: measured along their true direction, with v, -w <= -m, or one or both staying, they come no nearer
; than they are.
(push)
(assert (>= offset (* 2 rho)))
(assert (or (= s 0) (<= v (- m))))
(assert (or (= t 0) (<= (- w) (- m))))
(check-sat) ; expect sat
(assert (< (+ (- offset (* s v) stray) (* t w) other) offset))
(check-sat) ; expect unsat
(pop)
;
; Lemma 3: what holds along the two outermost directions (c, a) and (c, -a), of length 1, holds along every
; direction (x, y) of length 1 between them. The move is (v, w) then.
(declare-const c Real)
(declare-const a Real)
(declare-const x Real)
(declare-const y Real)
(assert (and (> c 0) (>= a 0) (= (+ (* c c) (* a a)) 1)))
(assert (and (= (+ (* x x) (* y y)) 1) (>= x c)))
(assert (<= (+ (* c v) (* a w)) (- m)))
(assert (<= (- (* c v) (* a w)) (- m)))
(check-sat) ; expect sat
(assert (> (+ (* x v) (* y w)) (- m)))
(check-sat) ; expect unsat
