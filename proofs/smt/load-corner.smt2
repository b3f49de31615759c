; The load of a sender with two receivers is largest at a corner of the moves.
;
; h(a, b, g) = f(a, b) + k(a, g): the sender has travelled the share a of its move, the receivers b
; and g of theirs, each term being a convex function of the shares. On the way to a corner one share
; after the other is taken to 0 or 1: along each, h is convex, hence at most the larger of its
; values at the ends. Applied three times to the inside value h:
;
;   h <= max(h0, h1), h0 <= max(h00, h01), h00 <= max(h000, h001), and so on,
;
; where a convex function between its ends is t end + (1 - t) start.
;
; Lemma: h is at most the bound W = max over the sender's end of the sum of the maxima over the
; receivers' ends, which is what `worst_corner` computes.
(set-logic QF_NRA)
; f_ij: first receiver's term, sender at end i, receiver at end j; k_ij: the second's.
(declare-const f00 Real) (declare-const f01 Real) (declare-const f10 Real) (declare-const f11 Real)
(declare-const k00 Real) (declare-const k01 Real) (declare-const k10 Real) (declare-const k11 Real)
(declare-const a Real) (declare-const b Real) (declare-const g Real)
(define-fun larger ((x Real) (y Real)) Real (ite (> y x) y x))
(define-fun between ((t Real) (x Real) (y Real)) Real (+ (* t y) (* (- 1 t) x)))
(declare-const h Real) (declare-const h0 Real) (declare-const h1 Real)
(assert (and (<= 0 a 1) (<= 0 b 1) (<= 0 g 1)))
; Convex in the sender's share; at each end of it, convex in each receiver's.
(assert (<= h (between a h0 h1)))
(assert (<= h0 (+ (between b f00 f01) (between g k00 k01))))
(assert (<= h1 (+ (between b f10 f11) (between g k10 k11))))
(check-sat) ; expect sat
(assert (> h (larger (+ (larger f00 f01) (larger k00 k01)) (+ (larger f10 f11) (larger k10 k11)))))
(check-sat) ; expect unsat
