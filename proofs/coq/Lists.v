(** About trees, states and lists of numbers, before any specification. *)

From Coq Require Import Bool List Arith NArith Lia Sorted.
From Tumato Require Import Semantics Checker.
Import ListNotations.

(** ** Trees and states *)

Lemma seq_at : forall size start v, nth_error (seq start size) v = if v <? size then Some (start + v) else None.
Proof.
  induction size as [|size IH]; intros start v; destruct v as [|v]; cbn [seq nth_error]; try reflexivity.
  - now rewrite Nat.add_0_r.
  - rewrite IH, Nat.add_succ_r. reflexivity.
Qed.

Lemma lookup_build : forall X sizes (f : state -> X) s x,
  lookup (build f sizes) s = Some x <-> Forall2 lt s sizes /\ x = f s.
Proof.
  intros X sizes. induction sizes as [|size sizes IH]; intros f s x; destruct s as [|v s]; cbn.
  - split; [intros [= <-]; auto | intros [_ ->]; reflexivity].
  - split; [discriminate | intros [H _]; inversion H].
  - split; [discriminate | intros [H _]; inversion H].
  - rewrite nth_error_map, seq_at. destruct (Nat.ltb_spec v size) as [small|large]; cbn.
    + rewrite IH. split.
      * intros [H ->]; auto.
      * intros [H ->]. inversion H; auto.
    + split; [discriminate | intros [H _]; inversion H; lia].
Qed.

Lemma in_all_states : forall sizes s, In s (all_states sizes) <-> Forall2 lt s sizes.
Proof.
  intros sizes s. split.
  - revert s. induction sizes as [|size sizes IH]; cbn; intros s H; [destruct H as [<-|[]]; constructor|].
    apply in_flat_map in H. destruct H as [v [Hv H]]. apply in_map_iff in H. destruct H as [t [<- Ht]].
    apply in_seq in Hv. constructor; [lia | now apply IH].
  - intros H. induction H as [|v size s sizes small _ IH]; cbn; [now left|].
    apply in_flat_map. exists v. split; [apply in_seq; lia | now apply in_map].
Qed.

(** Among the first [length space + 1] members of a sequence in [space], two are the same. *)
Lemma pigeonhole : forall (f : nat -> state) space, (forall k, In (f k) space) ->
  exists i j, i < j <= length space /\ f i = f j.
Proof.
  intros f space inside.
  set (past := fix past n := match n with 0 => [] | S n => f n :: past n end).
  assert (P : forall n s, In s (past n) <-> exists i, i < n /\ f i = s).
  { induction n as [|n IH]; intros s; cbn [past In].
    - split; [contradiction | intros [i [H _]]; lia].
    - rewrite IH. split.
      + intros [<-|[i [H <-]]]; [exists n | exists i]; split; auto; lia.
      + intros [i [H <-]]. destruct (Nat.eq_dec i n) as [->|]; [now left | right; exists i; split; [lia | reflexivity]]. }
  assert (D : forall n, (exists i j, i < j < n /\ f i = f j) \/ NoDup (past n)).
  { induction n as [|n [[i [j [H E]]]|nd]]; [right; constructor | left; exists i, j; split; [lia | exact E] |].
    destruct (in_dec (list_eq_dec Nat.eq_dec) (f n) (past n)) as [H|H].
    - left. apply P in H. destruct H as [i [H E]]. exists i, n. split; [lia | exact E].
    - right. now constructor. }
  assert (L : forall n, length (past n) = n) by (induction n; cbn; congruence).
  destruct (D (S (length space))) as [[i [j [H E]]]|nd]; [exists i, j; split; [lia | exact E]|].
  assert (short : length (past (S (length space))) <= length space).
  { apply NoDup_incl_length; [exact nd|]. intros s H. apply P in H. destruct H as [i [_ <-]]. apply inside. }
  rewrite L in short. lia.
Qed.

Lemma is_true_at_spec : forall sizes f s, is_true_at (build f sizes) s = true <-> Forall2 lt s sizes /\ f s = true.
Proof.
  intros sizes f s. unfold is_true_at. assert (K := lookup_build _ sizes f s).
  destruct (lookup (build f sizes) s) as [b|].
  - destruct (proj1 (K b) eq_refl) as [H ->]. tauto.
  - split; [discriminate|]. intros H. assert (F : None = Some true) by (apply K; split; [apply H | now symmetry]).
    discriminate F.
Qed.

(** ** Small questions *)

(** [&&&] and [|||] are [&&] and [||]. *)
Ltac eager := repeat
  match goal with
  | |- context [if ?a then ?b else false] => change (if a then b else false) with (a && b)
  | |- context [if ?a then true else ?b] => change (if a then true else b) with (a || b)
  end.

Lemma every_forallb : forall X (f : X -> bool) l, every f l = forallb f l.
Proof. intros X f l. induction l as [|x l IH]; [reflexivity|]. cbn. now rewrite IH. Qed.

Lemma not_more_spec : forall e f, not_more e f = true <-> at_most e f.
Proof.
  intros e f. unfold not_more, at_most. now rewrite orb_true_iff, andb_true_iff, !N.ltb_lt, N.eqb_eq, N.leb_le.
Qed.

Lemma less_spec : forall e f, less e f = true <-> ~ at_most f e.
Proof.
  intros e f. unfold less, at_most. rewrite orb_true_iff, andb_true_iff, !N.ltb_lt, N.eqb_eq. lia.
Qed.

Lemma same_list_eq : forall s t, same_list s t = true <-> s = t.
Proof.
  induction s as [|v s IH]; intros [|w t]; cbn; try (split; congruence).
  rewrite andb_true_iff, Nat.eqb_eq, IH. split; [intros [-> ->]; reflexivity | intros [= -> ->]; auto].
Qed.

Lemma member_in : forall a A, member a A = true <-> In a A.
Proof.
  intros a A. unfold member. rewrite existsb_exists. split.
  - intros [b [H E]]. apply Nat.eqb_eq in E. now subst.
  - intros H. exists a. split; [exact H | apply Nat.eqb_refl].
Qed.

Lemma disjoint_spec : forall A B, disjoint A B = true <-> forall r, In r A -> ~ In r B.
Proof.
  intros A B. unfold disjoint. rewrite forallb_forall. split; intros H r HA.
  - intros HB. apply member_in in HB. specialize (H r HA). now rewrite HB in H.
  - apply negb_true_iff. destruct (member r B) eqn:E; [|reflexivity].
    apply member_in in E. destruct (H r HA E).
Qed.

Lemma agree_spec : forall e f, agree e f = true <-> forall x v w, In (x, v) e -> In (x, w) f -> v = w.
Proof.
  intros e f. unfold agree. rewrite forallb_forall. split.
  - intros H x v w He Hf. specialize (H _ He). rewrite forallb_forall in H. specialize (H _ Hf).
    cbn in H. rewrite Nat.eqb_refl in H. now apply Nat.eqb_eq.
  - intros H [x v] He. apply forallb_forall. intros [y w] Hf. cbn.
    destruct (Nat.eqb_spec x y) as [<-|]; [|reflexivity].
    cbn. apply Nat.eqb_eq. now apply (H x).
Qed.

Lemma increasing_below_spec : forall most A least,
  increasing_below most least A = true <-> StronglySorted lt A /\ forall a, In a A -> least <= a < most.
Proof.
  intros most A. induction A as [|a A IH]; cbn [increasing_below]; intros least.
  { split; [intros _; split; [constructor | contradiction] | reflexivity]. }
  rewrite !andb_true_iff, Nat.leb_le, Nat.ltb_lt, IH. split.
  - intros [[low high] [sorted bounds]]. split.
    + constructor; [exact sorted|]. apply Forall_forall. intros b Hb. apply bounds in Hb. lia.
    + intros b [<-|Hb]; [lia | apply bounds in Hb; lia].
  - intros [sorted bounds]. assert (here := bounds a (or_introl eq_refl)).
    inversion sorted as [|? ? sorted' above]; subst. rewrite Forall_forall in above.
    split; [lia | split; [exact sorted'|]]. intros b Hb.
    assert (B := bounds b (or_intror Hb)). apply above in Hb. lia.
Qed.

Lemma sorted_nodup : forall A, StronglySorted lt A -> NoDup A.
Proof.
  induction 1 as [|a A _ IH above]; constructor; [|exact IH].
  intros H. rewrite Forall_forall in above. apply above in H. lia.
Qed.

Lemma seq_sorted : forall n start, StronglySorted lt (seq start n).
Proof.
  induction n as [|n IH]; intros start; cbn; constructor; [apply IH|].
  apply Forall_forall. intros a H. apply in_seq in H. lia.
Qed.

Lemma filter_sorted : forall (f : nat -> bool) A, StronglySorted lt A -> StronglySorted lt (filter f A).
Proof.
  intros f A. induction 1 as [|a A _ IH above]; cbn; [constructor|].
  destruct (f a); [|exact IH]. constructor; [exact IH|].
  rewrite Forall_forall in *. intros b H. apply filter_In in H. now apply above.
Qed.
