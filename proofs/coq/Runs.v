(** The checker's answers about runs, of a policy and of one that is changed in one state. *)

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

(** The run from [s] that starts with [A] and goes on with [pi] meets its goal within the bound, in a safe state. *)
Definition reaches (pi : policy) (s : state) (A : actions) : Prop :=
  exists k, within_bound spec (S k) /\ safe spec (follow pi (delta spec s A) k) /\
    met spec s A (follow pi (delta spec s A) k).

Definition states : list state := all_states (sizes spec).

Definition fuel : nat := length states.

Local Notation serves := (serves spec (safe_at spec) fuel).

Lemma hit_spec : forall s A t,
  (if forallb (holds t A) (active spec s) then safe_at spec t else false) = true <-> safe spec t /\ met spec s A t.
Proof.
  intros s A t. eager. rewrite andb_true_iff, safe_at_spec. unfold met. rewrite forallb_forall. tauto.
Qed.

Lemma serves_reaches : forall pi s A, serves pi s A = true -> reaches pi s A.
Proof.
  intros pi s A H. unfold Checker.serves in H.
  apply (chase_true _ _ (delta spec s A) fuel 0) in H. destruct H as [k [W M]].
  exists k. split; [exact W | now apply hit_spec].
Qed.

(** A policy that does nothing but what is allowed; its runs stay among the valid states. *)
Definition keeps_ok (pi : policy) : Prop := forall s, valid spec s -> ok spec order s (pi s).

Lemma follow_valid : forall pi s, keeps_ok pi -> valid spec s -> forall k, valid spec (follow pi s k).
Proof.
  intros pi s keep H k. induction k as [|k IH]; [exact H|]. exact (proj1 (ok_delta _ _ _ _ (keep _ IH))).
Qed.

Lemma serves_spec : forall pi s A, keeps_ok pi -> ok spec order s A -> serves pi s A = true <-> reaches pi s A.
Proof.
  intros pi s A keep allowed. split; [apply serves_reaches|]. intros [k [W M]].
  destruct (serves pi s A) eqn:E; [reflexivity|]. unfold Checker.serves in E.
  set (hit := fun t => if forallb (holds t A) (active spec s) then safe_at spec t else false) in E.
  set (next := fun t => delta spec t (pi t)) in E.
  assert (inside : forall j, In (steps next (delta spec s A) j) states).
  { intros j. apply in_all_states. exact (proj1 (follow_valid pi _ keep (proj1 (ok_delta _ _ _ _ allowed)) j)). }
  assert (F : hit (steps next (delta spec s A) k) = false).
  { apply (chase_false hit next (delta spec s A) _ inside fuel 0 0 1%N 1%N); auto. intros m Hm. lia. }
  apply hit_spec in M. unfold follow in M. fold next in M. unfold hit in F. congruence.
Qed.

Lemma run_follow : forall pi s k, run spec pi s (S k) = follow pi (delta spec s (pi s)) k.
Proof.
  intros pi s k. induction k as [|k IH]; [reflexivity|].
  change (run spec pi s (S (S k))) with (delta spec (run spec pi s (S k)) (pi (run spec pi s (S k)))).
  now rewrite IH.
Qed.

Lemma reaches_own : forall pi s, reaches pi s (pi s) <->
  exists k, 1 <= k /\ within_bound spec k /\ safe spec (run spec pi s k) /\ met spec s (pi s) (run spec pi s k).
Proof.
  intros pi s. split.
  - intros [k [W M]]. exists (S k). rewrite run_follow. split; [lia | auto].
  - intros [k [P [W M]]]. destruct k as [|k]; [lia|]. exists k. rewrite run_follow in M. auto.
Qed.

(** ** The changed policy *)

Lemma change_here : forall pi s A, change pi s A s = A.
Proof. intros pi s A. unfold change. now destruct (list_eq_dec Nat.eq_dec s s). Qed.

Lemma change_there : forall pi s A t, t <> s -> change pi s A t = pi t.
Proof. intros pi s A t H. unfold change. now destruct (list_eq_dec Nat.eq_dec t s). Qed.

Lemma change_ok : forall pi s A, keeps_ok pi -> ok spec order s A -> keeps_ok (change pi s A).
Proof.
  intros pi s A keep allowed t V. destruct (list_eq_dec Nat.eq_dec t s) as [->|differ].
  - now rewrite change_here.
  - rewrite change_there by exact differ. now apply keep.
Qed.

Lemma swap_change : forall pi s A t, swap pi s A t = change pi s A t.
Proof.
  intros pi s A t. unfold swap, change. destruct (same_list t s) eqn:E, (list_eq_dec Nat.eq_dec t s) as [H|H]; auto.
  - now apply same_list_eq in E.
  - apply same_list_eq in H. congruence.
Qed.

Lemma chase_ext : forall hit next next', (forall t, next t = next' t) -> forall n k past lag patience here,
  chase spec hit next n k past lag patience here = chase spec hit next' n k past lag patience here.
Proof.
  intros hit next next' same. induction n as [|n IH]; intros k past lag patience here; [reflexivity|].
  cbn [chase]. now rewrite same, !IH.
Qed.

Lemma serves_swap : forall pi s A t B, serves (swap pi s A) t B = serves (change pi s A) t B.
Proof. intros pi s A t B. apply chase_ext. intros u. now rewrite swap_change. Qed.

(** Where unsafe states are left for good by any step, only the run from the changed state matters. *)
Lemma alone_follow : forall pi s A, alone spec = true -> keeps_ok pi -> ~ safe spec s ->
  forall k t, safe spec t -> safe spec (follow pi t k) /\ follow (change pi s A) t k = follow pi t k.
Proof.
  intros pi s A lone keep U k t T. induction k as [|k [here same]]; [now split|].
  unfold follow in *. cbn [steps]. rewrite same. set (u := steps _ t k) in *.
  rewrite change_there by (intros ->; contradiction).
  split; [|reflexivity]. apply (alone_kept _ u); [exact lone | apply here |]. apply (ok_delta _ order), keep, here.
Qed.

Lemma alone_reaches : forall pi s A t B, alone spec = true -> keeps_ok pi -> ~ safe spec s ->
  valid spec t -> ok spec order t B -> reaches (change pi s A) t B <-> reaches pi t B.
Proof.
  intros pi s A t B lone keep U V allowed. assert (K := ok_delta _ _ _ _ allowed).
  apply (alone_kept _ _ _ lone V) in K. unfold reaches.
  split; intros [k M]; exists k; now rewrite (proj2 (alone_follow pi s A lone keep U k _ K)) in *.
Qed.

Lemma all_served_spec : forall pi s A, keeps_ok pi -> valid spec s -> ~ safe spec s -> ok spec order s A ->
  (forall t, valid spec t -> reaches pi t (pi t)) ->
  all_served spec (valid_at spec) (safe_at spec) states fuel pi s A = true <->
  forall t, valid spec t -> reaches (change pi s A) t (change pi s A t).
Proof.
  intros pi s A keep V U allowed reach. assert (keep' := change_ok pi s A keep allowed).
  unfold all_served. cbv zeta. rewrite every_forallb. eager.
  rewrite andb_true_iff, orb_true_iff, forallb_forall, serves_swap, (serves_spec _ _ _ keep' allowed). split.
  - intros [own others] t W. destruct (list_eq_dec Nat.eq_dec t s) as [->|differ]; [now rewrite change_here|].
    destruct others as [lone|others].
    + rewrite change_there by exact differ. apply alone_reaches; auto.
    + assert (I : In t states) by (apply in_all_states, W). specialize (others t I).
      rewrite (proj2 (valid_at_spec _ t) W), serves_swap, swap_change in others. now apply serves_reaches.
  - intros H. split; [specialize (H s V); now rewrite change_here in H|]. right. intros t I.
    destruct (valid_at spec t) eqn:W; [|reflexivity]. apply valid_at_spec in W.
    rewrite serves_swap, swap_change. apply serves_spec; auto.
Qed.

End Runs.
