; The distance of two robots is convex in the shares of their moves that they have travelled.
;
; The offset of two robots is affine in those shares: let u and v be its values for two choices of
; the shares, and t u + (1 - t) v the value between. With a = |u|, b = |v| and u . v <= a b
; (cauchy-schwarz.smt2):
;
; Lemma: |t u + (1 - t) v|^2 <= (t a + (1 - t) b)^2, the triangle inequality.
(set-logic QF_NRA)
(declare-const ux Real)
(declare-const uy Real)
(declare-const vx Real)
(declare-const vy Real)
(declare-const t Real)
(define-fun square ((x Real)) Real (* x x))
(define-fun uu () Real (+ (* ux ux) (* uy uy)))
(define-fun vv () Real (+ (* vx vx) (* vy vy)))
(define-fun uv () Real (+ (* ux vx) (* uy vy)))
(define-fun expanded ((t Real) (uu Real) (uv Real) (vv Real)) Real
  (+ (* t t uu) (* 2 t (- 1 t) uv) (* (- 1 t) (- 1 t) vv)))
; First, the left side is the expanded square, for every t.
(push)
(assert (distinct (+ (square (+ (* t ux) (* (- 1 t) vx))) (square (+ (* t uy) (* (- 1 t) vy))))
                  (expanded t uu uv vv)))
(check-sat) ; expect unsat
(pop)
; Then the lemma, from lengths and scalar product alone.
(declare-const a Real)
(declare-const b Real)
(declare-const product Real)
(assert (and (>= a 0) (>= b 0) (<= product (* a b)) (<= 0 t 1)))
(check-sat) ; expect sat
(assert (> (expanded t (* a a) product (* b b)) (square (+ (* t a) (* (- 1 t) b)))))
(check-sat) ; expect unsat
