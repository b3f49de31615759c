; No cycle closes where a post is attached only to one with a newer confirmation than any that it has
; passed on itself, for any number of posts, whichever messages are lost, late or copied.
;
; newest(x): the newest confirmation that x has ever passed on. above(x, y): y is x, or on the way up
; from x. What is heard of p was passed on by p at some time; this is `admits` and `pass_on` of
; `Confirmation`.
(declare-sort Post 0)
(declare-fun above (Post Post) Bool)
(declare-fun newest (Post) Int)
(declare-const r Post) (declare-const p Post) (declare-const heard Int) (declare-const bound Int)
(assert (forall ((x Post)) (above x x)))
(assert (forall ((x Post) (y Post) (z Post)) (=> (and (above x y) (above y z)) (above x z))))
(assert (forall ((x Post) (y Post)) (=> (and (above x y) (above y x)) (= x y))))
; The invariant: no post has passed on anything newer than what is above it.
(assert (forall ((x Post) (y Post)) (=> (above x y) (<= (newest x) (newest y)))))
(assert (and (<= heard (newest p)) (<= (newest r) bound)))
; r attaches to p: p is not below it, and the invariant holds afterwards (that the tree stays one
; then is the lemma of `forest.smt2`).
(define-fun above2 ((x Post) (y Post)) Bool
  (ite (above x r) (or (and (above x y) (above y r)) (above p y)) (above x y)))
(push)
(assert (> heard bound))
(check-sat) ; expect sat
(assert (or (above p r)
            (exists ((x Post) (y Post)) (and (above2 x y) (> (newest x) (newest y))))))
(check-sat) ; expect unsat
(pop)
; r is below p, and passes on what it hears of it.
(define-fun newest2 ((x Post)) Int (ite (and (= x r) (> heard (newest r))) heard (newest x)))
(push)
(assert (and (above r p) (not (= r p))
             (forall ((y Post)) (=> (and (above r y) (not (= r y))) (above p y)))))
(check-sat) ; expect sat
(assert (exists ((x Post) (y Post)) (and (above x y) (> (newest2 x) (newest2 y)))))
(check-sat) ; expect unsat
(pop)
; One that is only as new may come from r itself.
(assert (and (>= heard bound) (above p r) (not (= p r))))
(check-sat) ; expect sat
