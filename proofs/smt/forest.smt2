; A tree stays a tree when a robot attaches to another that is not below it, for any number of robots.
;
; above(x, y): y is x, or on the way up from x. Robot r attaches to p, with everything below it. That
; p is not below r is what `closes_cycle` asks of the way of p.
(declare-sort Node 0)
(declare-fun above (Node Node) Bool)
(declare-const r Node) (declare-const p Node)
(define-fun above2 ((x Node) (y Node)) Bool
  (ite (above x r) (or (and (above x y) (above y r)) (above p y)) (above x y)))
(define-fun tree () Bool (and
  (forall ((x Node)) (above x x))
  (forall ((x Node) (y Node) (z Node)) (=> (and (above x y) (above y z)) (above x z)))
  (forall ((x Node) (y Node)) (=> (and (above x y) (above y x)) (= x y)))
  (forall ((x Node) (y Node) (z Node)) (=> (and (above x y) (above x z)) (or (above y z) (above z y))))))
(define-fun tree2 () Bool (and
  (forall ((x Node)) (above2 x x))
  (forall ((x Node) (y Node) (z Node)) (=> (and (above2 x y) (above2 y z)) (above2 x z)))
  (forall ((x Node) (y Node)) (=> (and (above2 x y) (above2 y x)) (= x y)))
  (forall ((x Node) (y Node) (z Node)) (=> (and (above2 x y) (above2 x z)) (or (above2 y z) (above2 z y))))))
(assert tree)
(push)
(assert (not (above p r)))
(check-sat) ; expect sat
(assert (not tree2))
(check-sat) ; expect unsat
(pop)
; If p is below r, a cycle closes.
(assert (and (above p r) (not (= p r)) (not tree2)))
(check-sat) ; expect sat
