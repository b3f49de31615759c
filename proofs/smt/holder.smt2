; No post has two holders, for any number of robots and any length of Σ, whichever messages are lost, late
; or copied, and whichever robots stop or begin again.
;
; A bearer is a robot, or the robot with which it has exchanged its duty (`exchange.smt2`): an exchange
; changes nothing here. Places of Σ are named by their posts, as it passes no post twice. The bearer of a place
; holds its post while it waits there; it gives it up (`yield_post`), or leaves for the next place (`set_out`)
; and reports that it has arrived there (`report_arrival`). Either is final, and releases the post: the
; bearer behind may take it (`coming_post`) once it has heard of that, however late; what is heard was said
; (`maxima.smt2`). A bearer takes its own post again only if it has not released it. A robot that begins again
; forgets its post, and counts as no holder until it takes a new one (`joined`, `new_post`).
(declare-sort Bearer 0)
(declare-sort Post 0)
(declare-fun place (Bearer) Post)
(declare-fun behind (Post Post) Bool)            ; behind(p, q): the place of q is the next one from that of p
(assert (forall ((p Post) (q Post) (r Post)) (=> (and (behind p r) (behind q r)) (= p q))))
(assert (forall ((p Post) (q Post) (r Post)) (=> (and (behind p q) (behind p r)) (= q r))))
(declare-fun on (Post) Bool)                     ; it is a post of Σ
(assert (forall ((p Post) (q Post)) (=> (behind p q) (and (on p) (on q) (not (= p q))))))
; The state. `member`: it is on Σ or was; `counts`: it holds the post `post`, and has not given it up.
(declare-fun member (Bearer) Bool) (declare-fun member2 (Bearer) Bool)
(declare-fun waits (Bearer) Bool) (declare-fun waits2 (Bearer) Bool)
(declare-fun shifts (Bearer) Bool) (declare-fun shifts2 (Bearer) Bool)
(declare-fun holds (Bearer) Bool) (declare-fun holds2 (Bearer) Bool)
(declare-fun post (Bearer) Post) (declare-fun post2 (Bearer) Post)
(declare-fun given-up (Post) Bool) (declare-fun given-up2 (Post) Bool)
(declare-fun arrived (Post) Bool) (declare-fun arrived2 (Post) Bool)
(define-fun released ((i Post)) Bool (or (given-up i) (arrived i)))
(define-fun released2 ((i Post)) Bool (or (given-up2 i) (arrived2 i)))
(define-fun counts ((x Bearer)) Bool (and (holds x) (not (and (waits x) (given-up (place x))))))
(define-fun counts2 ((x Bearer)) Bool (and (holds2 x) (not (and (waits2 x) (given-up2 (place x))))))
; The promise is the first line; the rest is what makes it inductive.
(define-fun before () Bool (and
  (forall ((x Bearer) (y Bearer)) (=> (and (counts x) (counts y) (= (post x) (post y))) (= x y)))
  (forall ((x Bearer)) (=> (member x) (on (place x))))
  (forall ((x Bearer) (y Bearer)) (=> (and (member x) (member y) (= (place x) (place y))) (= x y)))
  (forall ((x Bearer)) (=> (waits x) (and (member x) (holds x) (not (shifts x)) (= (post x) (place x)))))
  (forall ((x Bearer)) (=> (shifts x) (and (member x) (not (holds x)))))
  (forall ((x Bearer)) (not (and (waits x) (arrived (place x)))))
  (forall ((x Bearer)) (=> (and (holds x) (not (waits x)) (on (post x))) (and (member x)
    (or (and (= (post x) (place x)) (not (released (post x))))
        (and (behind (place x) (post x)) (released (post x)))))))))
(define-fun after () Bool (and
  (forall ((x Bearer) (y Bearer)) (=> (and (counts2 x) (counts2 y) (= (post2 x) (post2 y))) (= x y)))
  (forall ((x Bearer)) (=> (member2 x) (on (place x))))
  (forall ((x Bearer) (y Bearer)) (=> (and (member2 x) (member2 y) (= (place x) (place y))) (= x y)))
  (forall ((x Bearer)) (=> (waits2 x) (and (member2 x) (holds2 x) (not (shifts2 x)) (= (post2 x) (place x)))))
  (forall ((x Bearer)) (=> (shifts2 x) (and (member2 x) (not (holds2 x)))))
  (forall ((x Bearer)) (not (and (waits2 x) (arrived2 (place x)))))
  (forall ((x Bearer)) (=> (and (holds2 x) (not (waits2 x)) (on (post2 x))) (and (member2 x)
    (or (and (= (post2 x) (place x)) (not (released2 (post2 x))))
        (and (behind (place x) (post2 x)) (released2 (post2 x)))))))))
; Bearer a takes a step.
(declare-const a Bearer)
(assert (forall ((x Bearer)) (=> (not (= x a)) (and (= (member2 x) (member x)) (= (waits2 x) (waits x))
  (= (shifts2 x) (shifts x)) (= (holds2 x) (holds x)) (= (post2 x) (post x))))))
(define-fun says-nothing () Bool
  (forall ((i Post)) (and (= (given-up2 i) (given-up i)) (= (arrived2 i) (arrived i)))))
(define-fun stays-as-it-is () Bool (and (= (member2 a) (member a)) (= (waits2 a) (waits a))
  (= (shifts2 a) (shifts a)) (= (holds2 a) (holds a)) (= (post2 a) (post a))))
(define-fun is-new ((p Post)) Bool
  (and (not (on p)) (forall ((x Bearer)) (not (= (post x) p)))))
; It holds a post off Σ from now on.
(define-fun takes ((p Post)) Bool
  (and (holds2 a) (not (waits2 a)) (not (shifts2 a)) (= (post2 a) p) (= (member2 a) (member a))))
(assert before)
(check-sat) ; expect sat
; `join_path`: its post is on Σ.
(push)
(assert (and says-nothing (holds a) (not (waits a)) (not (shifts a)) (member a) (= (post a) (place a))))
(assert (and (waits2 a) (not (shifts2 a)) (holds2 a) (= (post2 a) (post a)) (= (member2 a) (member a))))
(assert (not after))
(check-sat) ; expect unsat
(pop)
; `yield_post`.
(push)
(assert (and stays-as-it-is (waits a)))
(assert (forall ((i Post)) (and (= (arrived2 i) (arrived i))
  (= (given-up2 i) (or (given-up i) (= i (place a)))))))
(assert (not after))
(check-sat) ; expect unsat
(pop)
; `set_out`.
(push)
(assert (and says-nothing (waits a) (shifts2 a) (not (waits2 a)) (not (holds2 a)) (= (post2 a) (post a))
  (= (member2 a) (member a))))
(assert (not after))
(check-sat) ; expect unsat
(pop)
; `report_arrival`.
(push)
(assert (and stays-as-it-is (shifts a)))
(assert (forall ((i Post)) (and (= (given-up2 i) (given-up i))
  (= (arrived2 i) (or (arrived i) (= i (place a)))))))
(assert (not after))
(check-sat) ; expect unsat
(pop)
; It waits no longer, and keeps the post that it has not given up (`leave_path`).
(push)
(assert (and says-nothing (waits a) (takes (post a))))
(push)
(assert (not (given-up (place a))))
(assert (not after))
(check-sat) ; expect unsat
(pop)
; If it could keep one that it has given up, the robot behind would hold it as well.
(assert (not after))
(check-sat) ; expect sat
(pop)
; A new post (`leave_post`, `team_post`, `joined`, and `coming_post` where it may take none of Σ).
(push)
(declare-const new Post)
(assert (and says-nothing (takes new)))
(push)
(assert (is-new new))
(assert (not after))
(check-sat) ; expect unsat
(pop)
; If a robot that begins again keeps its first post, another may hold it by now.
(assert (and (not (holds a)) (not after)))
(check-sat) ; expect sat
(pop)
; The post ahead.
(push)
(declare-const ahead Post)
(assert (and says-nothing (shifts a) (behind (place a) ahead) (takes ahead)))
(push)
(assert (released ahead))
(assert (not after))
(check-sat) ; expect unsat
(pop)
; If it does not wait until that is released, two hold it.
(assert (not after))
(check-sat) ; expect sat
(pop)
; The post that it has left, again.
(push)
(assert (and says-nothing (shifts a) (takes (place a))))
(push)
(assert (not (released (place a))))
(assert (not after))
(check-sat) ; expect unsat
(pop)
; If it does so although it has reported its arrival, the robot behind holds it as well.
(assert (not (given-up (place a))))
(assert (not after))
(check-sat) ; expect sat
(pop)
; It begins again.
(push)
(assert (and says-nothing (not (holds2 a)) (not (waits2 a)) (not (shifts2 a)) (not (member2 a))))
(assert (not after))
(check-sat) ; expect unsat
(pop)
