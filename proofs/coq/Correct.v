(** The checker is right: it answers [true] exactly for the tables of sound, complete and minimal policies. *)

From Coq Require Import Bool List Arith NArith Lia Sorted Permutation.
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

(** ** Small questions *)

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

Section Correctness.

Variables (spec : specification) (order : ordering).

Lemma all_hold_spec : forall s fs, forallb (holds s []) fs = true <-> all_hold s fs.
Proof. intros s fs. apply forallb_forall. Qed.

Lemma assumed_spec : forall s, is_state spec s -> assumed spec s = true <-> valid spec s.
Proof. intros s H. unfold assumed, valid. rewrite all_hold_spec. tauto. Qed.

Definition fine : state -> bool := is_true_at (build (keeps_rules spec) (sizes spec)).

Lemma fine_safe : forall s, fine s = true <-> safe spec s.
Proof.
  intros s. unfold fine, is_true_at.
  assert (K : forall b, lookup (build (keeps_rules spec) (sizes spec)) s = Some b <->
    is_state spec s /\ b = keeps_rules spec s) by (intros b; apply lookup_build).
  assert (R : is_state spec s -> keeps_rules spec s = true <-> safe spec s).
  { intros H. unfold keeps_rules, safe. now rewrite andb_true_iff, assumed_spec, all_hold_spec. }
  destruct (lookup _ s) as [b|] eqn:E.
  - destruct (proj1 (K b) eq_refl) as [H ->]. now apply R.
  - split; [discriminate|]. intros H. assert (I : is_state spec s) by apply H.
    assert (F : None = Some true) by (apply K; split; [exact I | symmetry; now apply R]). discriminate F.
Qed.

(** ** What a step can lead to *)

Lemma one_fine_spec : forall s A,
  one_fine spec fine s A = true <-> forall a e, In a A -> In e (effects spec a) -> fine (apply e s) = true.
Proof.
  intros s A. unfold one_fine. rewrite forallb_forall. split.
  - intros H a e Ha He. specialize (H a Ha). rewrite forallb_forall in H. now apply H.
  - intros H a Ha. apply forallb_forall. intros e He. now apply (H a).
Qed.

Lemma in_after_one : forall f s A a e, In (s, A) f -> In a A -> In e (effects spec a) -> apply e s <> s ->
  In (apply e s, without a A) (after_one spec f).
Proof.
  intros f s A a e H Ha He new. unfold after_one. apply in_flat_map. exists (s, A). split; [exact H|].
  apply in_flat_map. exists a. split; [exact Ha|]. apply in_map_iff. exists e. split; [reflexivity|].
  apply filter_In. split; [exact He|]. apply negb_true_iff, not_true_iff_false. now rewrite same_list_eq.
Qed.

Lemma after_one_in : forall f p, In p (after_one spec f) ->
  exists s A a e, In (s, A) f /\ In a A /\ In e (effects spec a) /\ p = (apply e s, without a A).
Proof.
  intros f p H. unfold after_one in H. apply in_flat_map in H. destruct H as [[s A] [Hf H]].
  apply in_flat_map in H. destruct H as [a [Ha H]]. apply in_map_iff in H. destruct H as [e [<- He]].
  apply filter_In in He. now exists s, A, a, e.
Qed.

Lemma in_without_repeats : forall f p, In p (without_repeats f) <-> In p f.
Proof.
  induction f as [|q f IH]; intros p; [reflexivity|]. cbn [without_repeats]. destruct f as [|r f]; [reflexivity|].
  destruct (same_list (fst q) (fst r) && same_list (snd q) (snd r)) eqn:E.
  - rewrite IH. apply andb_true_iff in E. rewrite !same_list_eq in E. destruct q, r. cbn in E.
    destruct E as [-> ->]. cbn [In]. tauto.
  - change (q = p \/ In p (without_repeats (r :: f)) <-> q = p \/ In p (r :: f)). now rewrite IH.
Qed.

Lemma in_distinct : forall f p, In p (distinct f) <-> In p f.
Proof.
  intros f p. unfold distinct. rewrite in_without_repeats.
  split; apply Permutation_in; [apply Permutation_sym|]; apply PairSort.Permuted_sort.
Qed.

Lemma in_without : forall a A b, In b (without a A) <-> In b A /\ b <> a.
Proof. intros a A b. unfold without. now rewrite filter_In, negb_true_iff, Nat.eqb_neq. Qed.

Lemma without_length : forall a A, length (without a A) <= length A.
Proof. intros a A. unfold without. induction A as [|b A IH]; cbn; [lia | destruct (b =? a); cbn; lia]. Qed.

Lemma without_shorter : forall a A, In a A -> length (without a A) < length A.
Proof.
  intros a A. assert (L := without_length a). unfold without in *. induction A as [|b A IH]; cbn; [contradiction|].
  specialize (L A). destruct (Nat.eqb_spec b a) as [->|differ]; cbn; [lia|].
  intros [E|H]; [contradiction|]. apply IH in H. lia.
Qed.

Lemma struck_some : forall A s t, struck spec A s t -> exists a, In a A.
Proof. intros A s t H. destruct H as [A s a | A s a]; now exists a. Qed.

Lemma struck_fine_safe : forall A s t, struck spec A s t ->
  forall n f B, struck_fine spec fine n f = true -> In (s, B) f -> incl A B -> length B <= n -> fine t = true.
Proof.
  induction 1 as [A s a e Ha He | A s a e t Ha He further IH]; intros n f B F Hf more long.
  all: assert (HB := more a Ha).
  all: destruct n as [|n]; [destruct B; cbn in *; [contradiction | lia]|].
  all: pose proof F as G; cbn [struck_fine] in G; apply andb_true_iff in G; destruct G as [now later].
  - rewrite forallb_forall in now. specialize (now _ Hf). cbn [fst snd] in now. rewrite one_fine_spec in now. now apply (now a).
  - destruct (list_eq_dec Nat.eq_dec (apply e s) s) as [same|new].
    + apply (IH (S n) f B F); [now rewrite same | | exact long].
      intros b Hb. apply in_without in Hb. now apply more.
    + assert (shorter := without_shorter _ _ HB).
      assert (less : incl (without a A) (without a B)).
      { intros b Hb. apply in_without in Hb. apply in_without. split; [now apply more | apply Hb]. }
      destruct (struck_some _ _ _ further) as [b some]. apply less in some.
      destruct n as [|n]; [destruct (without a B); cbn in *; [contradiction | lia]|].
      apply (IH (S n) (distinct (after_one spec f)) (without a B) later); [|exact less | lia].
      now apply in_distinct, in_after_one.
Qed.

Lemma safe_struck_fine : forall n f,
  (forall s A t, In (s, A) f -> struck spec A s t -> fine t = true) -> struck_fine spec fine n f = true.
Proof.
  induction n as [|n IH]; intros f H; [reflexivity|].
  cbn [struck_fine]. apply andb_true_iff. split.
  - apply forallb_forall. intros [s A] Hf. apply one_fine_spec. intros a e Ha He.
    apply (H s A); [exact Hf | now apply last_effect with a].
  - destruct n as [|n]; [reflexivity|]. apply IH. intros t B u HB Hu.
    apply in_distinct, after_one_in in HB. destruct HB as (s & A & a & e & Hf & Ha & He & [= -> ->]).
    apply (H s A); [exact Hf | now apply next_effect with a e].
Qed.

Lemma out_fine_spec : forall s A,
  out_fine spec order fine s A = true <-> forall t, out spec order s A t -> safe spec t.
Proof.
  intros s A. unfold out_fine, out. destruct A as [|a A].
  { rewrite fine_safe. split; [now intros H t -> | auto]. }
  set (B := a :: A). destruct order.
  - split.
    + intros F t H. apply fine_safe. apply (struck_fine_safe _ _ _ H _ _ B F); [now left | now intros b | lia].
    + intros H. apply safe_struck_fine. intros s' A' t [[= <- <-]|[]] Ht. now apply fine_safe, H.
  - cbn [struck_fine forallb fst snd]. rewrite !andb_true_r, one_fine_spec. split.
    + intros F t (b & e & Hb & He & ->). apply fine_safe. now apply (F b).
    + intros H b e Hb He. apply fine_safe, H. now exists b, e.
Qed.

(** ** What is allowed *)

Lemma pairs_spec : forall A,
  forallb (fun a => forallb (fun b =>
    if a =? b then agree (nominal (the spec a)) (nominal (the spec a)) else compatible spec a b) A) A = true <->
  (forall a b r, In a A -> In b A -> a <> b -> In r (resources (the spec a)) -> ~ In r (resources (the spec b))) /\
  (forall a b x v w, In a A -> In b A ->
    In (x, v) (nominal (the spec a)) -> In (x, w) (nominal (the spec b)) -> v = w).
Proof.
  intros A. rewrite forallb_forall. split.
  - intros H.
    assert (P : forall a b, In a A -> In b A ->
      if a =? b then agree (nominal (the spec a)) (nominal (the spec a)) = true else compatible spec a b = true).
    { intros a b Ha Hb. specialize (H a Ha). rewrite forallb_forall in H. specialize (H b Hb). now destruct (a =? b). }
    split.
    + intros a b r Ha Hb differ. specialize (P a b Ha Hb). apply Nat.eqb_neq in differ. rewrite differ in P.
      apply andb_true_iff in P. now apply disjoint_spec.
    + intros a b x v w Ha Hb. specialize (P a b Ha Hb). destruct (Nat.eqb_spec a b) as [same|differ].
      * subst b. now apply agree_spec.
      * apply andb_true_iff in P. now apply agree_spec.
  - intros [R N] a Ha. apply forallb_forall. intros b Hb. destruct (Nat.eqb_spec a b) as [<-|differ].
    + apply agree_spec. intros x v w. now apply N.
    + apply andb_true_iff. split.
      * apply disjoint_spec. intros r. now apply R.
      * apply agree_spec. intros x v w. now apply N.
Qed.

Lemma is_ok_spec : forall s A, is_ok spec order fine s A = true <-> ok spec order s A.
Proof.
  intros s A. unfold is_ok. rewrite !andb_true_iff, pairs_spec, out_fine_spec, fine_safe, !forallb_forall.
  assert (same : (forall a, In a A -> applicable spec s a = true) <->
    (forall a, In a A -> all_hold s (preconditions (the spec a)))).
  { split; intros H a Ha; now apply all_hold_spec, H. }
  rewrite same. split.
  - intros [[[[P [R N]] Q] D] O]. now constructor.
  - intros [P R N Q O D]. tauto.
Qed.

(** ** Runs *)

(** The state after [k] steps of [next]. *)
Fixpoint steps (next : state -> state) (s : state) (k : nat) : state :=
  match k with 0 => s | S k => next (steps next s k) end.

Lemma is_within_spec : forall k, is_within spec (N.of_nat k) = true <-> within_bound spec k.
Proof.
  intros k. unfold is_within, within_bound. destruct (max_plan_length spec); [apply N.leb_le | tauto].
Qed.

Lemma within_less : forall j k, j <= k -> within_bound spec k -> within_bound spec j.
Proof. unfold within_bound. intros j k H. destruct (max_plan_length spec); [lia | auto]. Qed.

Section Chase.

Variables (hit : state -> bool) (next : state -> state) (start : state).

Let at_ (k : nat) : state := steps next start k.

(** After [n] steps the states come back in turn. *)
Lemma loop_closed : forall i n, i <= n -> at_ (S n) = at_ i -> forall k, exists m, m <= n /\ at_ k = at_ m.
Proof.
  intros i n order_ loop k. induction k as [|k [m [small same]]]; [exists 0; split; [lia | reflexivity]|].
  destruct (Nat.eq_dec m n) as [->|].
  - exists i. split; [exact order_|]. rewrite <- loop. unfold at_ in *. cbn. now rewrite same.
  - exists (S m). split; [lia|]. unfold at_ in *. cbn. now rewrite same.
Qed.

(** Steps are counted from 1, for the run has come to [start] by its first one. *)
Lemma chase_true : forall fuel n past lag patience,
  chase spec hit next fuel (N.of_nat (S n)) past lag patience (at_ n) = true ->
  exists k, within_bound spec (S k) /\ hit (at_ k) = true.
Proof.
  induction fuel as [|fuel IH]; intros n past lag patience; cbn [chase].
  all: destruct (is_within spec (N.of_nat (S n))) eqn:W; cbn [negb]; [|discriminate].
  all: apply is_within_spec in W; destruct (hit (at_ n)) eqn:h; [now exists n|].
  { discriminate. }
  change (next (at_ n)) with (at_ (S n)). rewrite <- Nat2N.inj_succ.
  destruct (same_list past (at_ (S n))); [discriminate|]. destruct (lag =? patience)%N; apply IH.
Qed.

Lemma loop_no_hit : forall i n, i <= n -> at_ (S n) = at_ i -> (forall m, m <= n -> hit (at_ m) = false) ->
  forall k, hit (at_ k) = false.
Proof.
  intros i n order_ loop none k. destruct (loop_closed i n order_ loop k) as [m [small ->]]. now apply none.
Qed.

Lemma chase_false : forall space, (forall k, In (at_ k) space) -> forall fuel n i lag patience,
  i <= n -> (forall m, m < n -> hit (at_ m) = false) -> length space <= n + fuel ->
  chase spec hit next fuel (N.of_nat (S n)) (at_ i) lag patience (at_ n) = false ->
  forall k, within_bound spec (S k) -> hit (at_ k) = false.
Proof.
  intros space inside. induction fuel as [|fuel IH]; intros n i lag patience past none enough; cbn [chase].
  all: destruct (is_within spec (N.of_nat (S n))) eqn:W; cbn [negb].
  2,4: intros _ k Hk; destruct (Nat.lt_ge_cases k n) as [small|large]; [now apply none|];
    apply (within_less (S n)) in Hk; [|lia]; apply is_within_spec in Hk; congruence.
  all: destruct (hit (at_ n)) eqn:h; [discriminate|].
  all: assert (none' : forall m, m <= n -> hit (at_ m) = false)
    by (intros m Hm; destruct (Nat.eq_dec m n) as [->|]; [exact h | apply none; lia]).
  - intros _ k _. destruct (pigeonhole at_ space inside) as (i' & j & H & E).
    destruct j as [|j]; [lia|]. apply (loop_no_hit i' j); [lia | now symmetry |].
    intros m Hm. apply none'. lia.
  - change (next (at_ n)) with (at_ (S n)). rewrite <- Nat2N.inj_succ.
    destruct (same_list (at_ i) (at_ (S n))) eqn:E.
    + apply same_list_eq in E. intros _ k _. now apply (loop_no_hit i n).
    + destruct (lag =? patience)%N; apply IH; try lia; intros m Hm; apply none'; lia.
Qed.

End Chase.

Definition follow (pi : policy) (s : state) : nat -> state := steps (fun t => delta spec t (pi t)) s.

(** The run from [s] that starts with [A] and goes on with [pi] meets its goal within the bound. *)
Definition reaches (pi : policy) (s : state) (A : actions) : Prop :=
  exists k, within_bound spec (S k) /\ met spec s A (follow pi (delta spec s A) k).

Lemma met_spec : forall s A t, forallb (holds t A) (active spec s) = true <-> met spec s A t.
Proof. intros s A t. apply forallb_forall. Qed.

Lemma serves_reaches : forall pi fuel s A, serves spec pi fuel s A = true -> reaches pi s A.
Proof.
  intros pi fuel s A H. unfold serves in H.
  apply (chase_true _ _ (delta spec s A) fuel 0) in H. destruct H as [k [W M]].
  exists k. split; [exact W | now apply met_spec].
Qed.

(** A policy that allows nothing but what is allowed; its runs stay among the states. *)
Definition keeps_ok (pi : policy) : Prop := forall s, valid spec s -> ok spec order s (pi s).

Lemma follow_safe : forall pi s, keeps_ok pi -> safe spec s -> forall k, safe spec (follow pi s k).
Proof.
  intros pi s keep H k. induction k as [|k IH]; [exact H|].
  exact (successor_safe _ _ _ _ (keep _ (proj1 IH))).
Qed.

Definition fuel : nat := length (all_states (sizes spec)).

Lemma serves_spec : forall pi s A, keeps_ok pi -> ok spec order s A ->
  serves spec pi fuel s A = true <-> reaches pi s A.
Proof.
  intros pi s A keep allowed. split; [apply serves_reaches|]. intros [k [W M]].
  destruct (serves spec pi fuel s A) eqn:E; [reflexivity|]. unfold serves in E.
  set (hit := fun t => forallb (holds t A) (active spec s)) in E. set (next := fun t => delta spec t (pi t)) in E.
  assert (inside : forall j, In (steps next (delta spec s A) j) (all_states (sizes spec))).
  { intros j. apply in_all_states. exact (proj1 (proj1 (follow_safe pi _ keep (successor_safe _ _ _ _ allowed) j))). }
  assert (F : hit (steps next (delta spec s A) k) = false).
  { apply (chase_false hit next (delta spec s A) _ inside fuel 0 0 1%N 1%N); auto. intros m Hm. lia. }
  apply met_spec in M. unfold hit in F. unfold follow in M. fold next in M. congruence.
Qed.

Lemma run_follow : forall pi s k, run spec pi s (S k) = follow pi (delta spec s (pi s)) k.
Proof.
  intros pi s k. induction k as [|k IH]; [reflexivity|].
  change (run spec pi s (S (S k))) with (delta spec (run spec pi s (S k)) (pi (run spec pi s (S k)))).
  now rewrite IH.
Qed.

Lemma reaches_own : forall pi s, reaches pi s (pi s) <->
  exists k, 1 <= k /\ within_bound spec k /\ met spec s (pi s) (run spec pi s k).
Proof.
  intros pi s. split.
  - intros [k [W M]]. exists (S k). rewrite run_follow. split; [lia | auto].
  - intros [k [P [W M]]]. destruct k as [|k]; [lia|]. exists k. rewrite run_follow in M. auto.
Qed.

(** ** Minimality: only the run from the changed state matters *)

Lemma change_here : forall pi s A, change pi s A s = A.
Proof. intros pi s A. unfold change. now destruct (list_eq_dec Nat.eq_dec s s). Qed.

Lemma change_there : forall pi s A t, t <> s -> change pi s A t = pi t.
Proof. intros pi s A t H. unfold change. now destruct (list_eq_dec Nat.eq_dec t s). Qed.

Lemma changed_run : forall pi s A, sound_and_complete spec order (change pi s A) -> valid spec s -> ~ safe spec s ->
  forall k, run spec (change pi s A) s (S k) = follow pi (delta spec s A) k /\
    safe spec (run spec (change pi s A) s (S k)).
Proof.
  intros pi s A right V U k.
  assert (go : forall t, valid spec t -> safe spec (delta spec t (change pi s A t))).
  { intros t Ht. destruct (right t Ht) as [_ [allowed _]]. exact (successor_safe _ _ _ _ allowed). }
  induction k as [|k [same here]].
  - change (run spec (change pi s A) s 1) with (delta spec s (change pi s A s)).
    split; [now rewrite change_here | now apply go].
  - set (t := run spec (change pi s A) s (S k)) in *.
    change (run spec (change pi s A) s (S (S k))) with (delta spec t (change pi s A t)).
    split; [|apply go, here].
    rewrite change_there by (intros ->; contradiction). now rewrite same.
Qed.

Lemma changed_reaches : forall pi s A, sound_and_complete spec order (change pi s A) -> valid spec s ->
  ~ safe spec s -> reaches pi s A.
Proof.
  intros pi s A right V U. destruct (right s V) as [_ [_ [k [P [W M]]]]].
  rewrite change_here in M. destruct k as [|k]; [lia|].
  exists k. split; [exact W|]. now rewrite <- (proj1 (changed_run pi s A right V U k)).
Qed.

(** The runs of the changed policy, but for the first step from [s], are those of [pi]. *)
Lemma changed_follow : forall pi s A, sound_and_complete spec order pi -> ~ safe spec s ->
  forall k t, safe spec t -> safe spec (follow pi t k) /\ follow (change pi s A) t k = follow pi t k.
Proof.
  intros pi s A right U k t T. induction k as [|k [here same]]; [now split|].
  unfold follow in *. cbn [steps]. rewrite same. set (u := steps _ t k) in *.
  rewrite change_there by (intros ->; contradiction).
  split; [|reflexivity]. destruct (right u (proj1 here)) as [_ [allowed _]]. exact (successor_safe _ _ _ _ allowed).
Qed.

Lemma reaches_changed : forall pi s A, sound_and_complete spec order pi -> ~ safe spec s ->
  action_set spec A -> ok spec order s A -> reaches pi s A -> sound_and_complete spec order (change pi s A).
Proof.
  intros pi s A right U set allowed reach t V. set (B := change pi s A t).
  assert (K : action_set spec B /\ ok spec order t B /\ reaches pi t B).
  { unfold B. destruct (list_eq_dec Nat.eq_dec t s) as [->|differ]; [rewrite change_here; auto|].
    rewrite change_there by exact differ. destruct (right t V) as [? [? ?]]. rewrite reaches_own. auto. }
  destruct K as [? [okB [k [W M]]]]. split; [assumption | split; [assumption|]].
  apply (proj1 (reaches_own (change pi s A) t)). exists k. split; [exact W|]. fold B.
  rewrite (proj2 (changed_follow pi s A right U k _ (successor_safe _ _ _ _ okB))). exact M.
Qed.

(** [minimal] as [docs/semantics.md] puts it the second time: no cheaper allowed set has a run that, continued by the
    policy, meets its goal. *)
Theorem minimal_iff : forall pi, sound_and_complete spec order pi ->
  minimal spec order pi <->
  forall s A, valid spec s -> ~ safe spec s -> action_set spec A -> ok spec order s A ->
    (total_duration spec A < total_duration spec (pi s))%N -> ~ reaches pi s A.
Proof.
  intros pi right. split; intros H s A V U set allowed cheap bad; apply (H s A V U set allowed cheap).
  - now apply reaches_changed.
  - now apply changed_reaches.
Qed.

(** ** Cheaper sets *)

Lemma all_cheaper_all : forall good cand, StronglySorted lt cand -> forall chosen budget,
  all_cheaper spec good cand chosen budget = true ->
  forall B, StronglySorted lt B -> incl B cand -> NoDup (rev chosen ++ B) ->
  (forall a b, In a (rev chosen ++ B) -> In b (rev chosen ++ B) -> a <> b -> compatible spec a b = true) ->
  (total_duration spec B < budget)%N -> good (rev chosen ++ B) = true.
Proof.
  intros good cand. induction 1 as [|a rest _ IH above]; cbn [all_cheaper]; intros chosen budget H B sorted inside nd comp cheap.
  - destruct B as [|b B]; [now rewrite app_nil_r | destruct (inside b (or_introl eq_refl))].
  - apply andb_true_iff in H. destruct H as [skip take].
    destruct (in_dec Nat.eq_dec a B) as [Ha|Ha].
    + assert (E : exists B', B = a :: B').
      { destruct B as [|b B]; [contradiction|]. exists B. f_equal.
        destruct Ha as [->|Ha]; [reflexivity|].
        destruct (inside b (or_introl eq_refl)) as [->|Hb]; [reflexivity|].
        inversion sorted as [|? ? _ after]; subst. rewrite Forall_forall in *.
        apply after in Ha. apply above in Hb. lia. }
      destruct E as [B' ->]. inversion sorted as [|? ? sorted' after]; subst.
      change (total_duration spec (a :: B')) with (duration (the spec a) + total_duration spec B')%N in cheap.
      assert (F : (duration (the spec a) <? budget)%N && forallb (compatible spec a) chosen = true).
      { apply andb_true_iff. split; [apply N.ltb_lt; lia|]. apply forallb_forall. intros b Hb.
        apply comp; [apply in_or_app; right; now left | apply in_or_app; left; now apply in_rev in Hb |].
        intros ->. apply NoDup_remove_2 in nd. apply nd, in_or_app. left. now apply in_rev in Hb. }
      rewrite F in take.
      assert (R : rev (a :: chosen) ++ B' = rev chosen ++ a :: B') by (cbn; now rewrite <- app_assoc).
      rewrite <- R. apply (IH _ _ take B' sorted').
      * intros b Hb. destruct (inside b (or_intror Hb)) as [<-|]; [|assumption].
        rewrite Forall_forall in after. apply after in Hb. lia.
      * now rewrite R.
      * now rewrite R.
      * lia.
    + apply (IH _ _ skip B sorted); auto.
      intros b Hb. destruct (inside b Hb) as [<-|]; [contradiction | assumption].
Qed.

Lemma all_cheaper_from : forall good cand, StronglySorted lt cand -> forall chosen budget, (0 < budget)%N ->
  (forall B, StronglySorted lt B -> incl B cand -> (total_duration spec B < budget)%N -> good (rev chosen ++ B) = true) ->
  all_cheaper spec good cand chosen budget = true.
Proof.
  intros good cand. induction 1 as [|a rest _ IH above]; cbn [all_cheaper]; intros chosen budget some H.
  - rewrite <- (app_nil_r (rev chosen)). apply H; [constructor | now intros b | exact some].
  - apply andb_true_iff. split.
    + apply IH; [exact some|]. intros B sorted inside. apply H; [exact sorted|]. now apply incl_tl.
    + destruct (_ && _) eqn:E; [|reflexivity]. apply andb_true_iff in E. destruct E as [E _]. apply N.ltb_lt in E.
      apply IH; [lia|]. intros B sorted inside cheap. cbn [rev]. rewrite <- app_assoc. apply H.
      * constructor; [exact sorted|]. rewrite Forall_forall in *. intros b Hb. now apply above, inside.
      * intros b [<-|Hb]; [now left | right; now apply inside].
      * change (total_duration spec ([a] ++ B)) with (duration (the spec a) + total_duration spec B)%N. lia.
Qed.

Lemma candidates_sorted : forall s, StronglySorted lt (candidates spec fine s).
Proof. intros s. apply filter_sorted, seq_sorted. Qed.

Lemma ok_candidates : forall s A, action_set spec A -> ok spec order s A -> incl A (candidates spec fine s).
Proof.
  intros s A [sorted declared_] allowed a Ha. apply filter_In. split.
  - apply in_seq. specialize (declared_ a Ha). lia.
  - apply andb_true_iff. split.
    + apply all_hold_spec. now apply (preconditions_hold _ _ _ _ allowed).
    + apply one_fine_spec. intros b e [<-|[]] He. apply fine_safe. apply (outcomes_safe _ _ _ _ allowed).
      unfold out. destruct A as [|b A]; [contradiction|]. destruct order.
      * now apply last_effect with a.
      * now exists a, e.
Qed.

Lemma ok_compatible : forall s A a b, ok spec order s A -> In a A -> In b A -> a <> b -> compatible spec a b = true.
Proof.
  intros s A a b allowed Ha Hb differ. apply andb_true_iff. split.
  - apply disjoint_spec. intros r. now apply (resources_differ _ _ _ _ allowed).
  - apply agree_spec. intros x v w. now apply (nominals_agree _ _ _ _ allowed).
Qed.

Lemma no_better_spec : forall pi s A, keeps_ok pi ->
  no_better spec order fine pi fuel s A = true <->
  forall B, action_set spec B -> ok spec order s B -> (total_duration spec B < total_duration spec A)%N ->
    ~ reaches pi s B.
Proof.
  intros pi s A keep. unfold no_better. split.
  - intros H B set allowed cheap reach. apply orb_true_iff in H.
    destruct H as [H|H]; [apply N.eqb_eq in H; lia|].
    apply (all_cheaper_all _ _ (candidates_sorted s)) with (B := B) in H.
    + cbn [rev app] in H. rewrite (proj2 (is_ok_spec s B) allowed) in H.
      now rewrite (proj2 (serves_spec pi s B keep allowed) reach) in H.
    + apply set.
    + exact (ok_candidates s B set allowed).
    + apply sorted_nodup, set.
    + intros a b. now apply (ok_compatible s).
    + exact cheap.
  - intros H. apply orb_true_iff. destruct (N.eqb_spec (total_duration spec A) 0) as [|some]; [now left | right].
    apply all_cheaper_from; [apply candidates_sorted | lia|]. intros B sorted inside cheap. cbn [rev app].
    apply negb_true_iff, not_true_iff_false. rewrite andb_true_iff, is_ok_spec. intros [allowed reach].
    apply (H B); [|exact allowed | exact cheap | now apply serves_reaches in reach].
    split; [exact sorted|]. intros a Ha. apply inside, filter_In in Ha. destruct Ha as [Ha _]. apply in_seq in Ha. lia.
Qed.

(** ** The theorem *)

(** Every valid state has an entry. *)
Definition total (t : table) : Prop := forall s, valid spec s -> exists A, lookup t s = Some (Some A).

Lemma is_action_set_spec : forall A, is_action_set spec A = true <-> action_set spec A.
Proof.
  intros A. unfold is_action_set, action_set. rewrite increasing_below_spec.
  split; intros [sorted bounds]; (split; [exact sorted|]); intros a Ha; specialize (bounds a Ha); lia.
Qed.

Lemma check_spec : forall t, check spec order t = true <->
  forall s, valid spec s -> check_state spec order fine t fuel s = true.
Proof.
  intros t. unfold check. rewrite forallb_forall. split; intros H s.
  - intros V. assert (I : is_state spec s) by apply V. specialize (H s (proj2 (in_all_states _ _) I)).
    apply (assumed_spec s I) in V. now rewrite V in H.
  - intros I. apply in_all_states in I. destruct (assumed spec s) eqn:E; [|reflexivity].
    apply H. now apply assumed_spec.
Qed.

Lemma check_state_ok : forall t s, check_state spec order fine t fuel s = true -> ok spec order s (policy_of t s).
Proof.
  intros t s H. unfold check_state in H. unfold policy_of. destruct (lookup t s) as [[A|]|]; try discriminate.
  rewrite !andb_true_iff in H. now apply is_ok_spec.
Qed.

Lemma check_state_spec : forall t s, keeps_ok (policy_of t) ->
  check_state spec order fine t fuel s = true <->
  (exists A, lookup t s = Some (Some A)) /\
  action_set spec (policy_of t s) /\ ok spec order s (policy_of t s) /\ reaches (policy_of t) s (policy_of t s) /\
  (~ safe spec s -> forall B, action_set spec B -> ok spec order s B ->
    (total_duration spec B < total_duration spec (policy_of t s))%N -> ~ reaches (policy_of t) s B).
Proof.
  intros t s keep. unfold check_state. assert (E : forall A, lookup t s = Some (Some A) -> policy_of t s = A).
  { intros A E. unfold policy_of. now rewrite E. }
  destruct (lookup t s) as [[A|]|]; [|split; [discriminate | intros [[A H] _]; discriminate] ..].
  rewrite (E A eq_refl), !andb_true_iff, orb_true_iff, is_action_set_spec, is_ok_spec, fine_safe,
    (no_better_spec _ _ _ keep). split.
  - intros [[[set allowed] serve] best]. apply (serves_spec _ _ _ keep allowed) in serve.
    split; [now exists A|]. repeat (split; [assumption|]). intros U. now destruct best.
  - intros (_ & set & allowed & reach & best). apply (serves_spec _ _ _ keep allowed) in reach.
    split; [exact (conj (conj set allowed) reach)|]. destruct (fine s) eqn:F; [left; now apply fine_safe | right].
    apply best. rewrite <- fine_safe, F. discriminate.
Qed.

Theorem checker_exact : forall t, check spec order t = true <->
  total t /\ sound_and_complete spec order (policy_of t) /\ minimal spec order (policy_of t).
Proof.
  intros t. rewrite check_spec. split.
  - intros H. assert (keep : keeps_ok (policy_of t)) by (intros s V; now apply check_state_ok, H).
    assert (K : forall s, valid spec s -> _) by (intros s V; exact (proj1 (check_state_spec t s keep) (H s V))).
    assert (right : sound_and_complete spec order (policy_of t)).
    { intros s V. destruct (K s V) as (_ & set & allowed & reach & _). rewrite <- reaches_own. auto. }
    split; [intros s V; apply (K s V) | split; [exact right|]].
    apply minimal_iff; [exact right|]. intros s A V U. now apply (K s V).
  - intros (entries & right & best) s V. assert (keep : keeps_ok (policy_of t)) by (intros u W; apply (right u W)).
    apply (check_state_spec t s keep). destruct (right s V) as (set & allowed & reach).
    repeat (split; [auto|]); [now apply reaches_own|].
    intros U B. now apply (proj1 (minimal_iff _ right) best).
Qed.

Theorem checker_sound : forall t, check spec order t = true ->
  sound_and_complete spec order (policy_of t) /\ minimal spec order (policy_of t).
Proof. intros t H. now apply checker_exact in H. Qed.

End Correctness.

Print Assumptions checker_exact.
Print Assumptions checker_sound.
