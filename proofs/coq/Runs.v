(** The checker's answers about runs, and what minimality asks of them. *)

From Coq Require Import Bool List Arith NArith Lia.
From Tumato Require Import Semantics Checker Lists Steps.
Import ListNotations.

Section Runs.

Variables (spec : specification) (order : ordering).

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

End Runs.
