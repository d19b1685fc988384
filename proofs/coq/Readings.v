(** The definitions of [Semantics.v] in other words: what they say of sequences of outcomes, and where safety is restored
    in one step. The theorems about the checker do not rest on this file; it is for readers. *)

From Coq Require Import Bool List Arith NArith Lia.
From Tumato Require Import Semantics Checker Lists Steps Runs Restoring Better.
Import ListNotations.

(** ** The way to safety *)

Section Ways.

Variables (spec : specification) (order : ordering) (pi : policy).

Context (keep : keeps_ok spec order pi).

Lemma restored_later : forall s t u, level spec s <= level spec t -> restored spec t u -> restored spec s u.
Proof. unfold restored. intros s t u L [V M]. split; [exact V | lia]. Qed.

(** Within an effort: every sequence of outcomes meets a restored state. *)
Theorem every_sequence : forall s e, back_within spec (next spec order) pi s e -> valid spec s ->
  forall f : nat -> state, f 0 = s -> (forall k, next spec order (f k) (pi (f k)) (f (S k))) ->
  exists k, restored spec s (f k).
Proof.
  intros s e H. induction H as [s e rest _ _ _ IH]. intros V f start step.
  assert (N := step 0). rewrite start in N. destruct (restored_dec spec s (f 1)) as [R|R]; [now exists 1|].
  assert (K := steps_kept _ _ _ _ (keep s V) _ N).
  destruct (IH (f 1) N R (proj1 K) (fun k => f (S k)) eq_refl (fun k => step (S k))) as [k M].
  exists (S k). apply (restored_later s (f 1)); [now apply kept_level | exact M].
Qed.

(** Nominally, that is: the nominal run meets one. *)
Theorem nominal_run : forall s, valid spec s ->
  (exists e, back_within spec (nominally spec) pi s e) <-> exists k, restored spec s (run spec pi s k).
Proof.
  assert (later : forall s k, run spec pi s (S k) = run spec pi (delta spec s (pi s)) k).
  { intros s k. induction k as [|k IH]; [reflexivity|].
    change (run spec pi s (S (S k))) with (delta spec (run spec pi s (S k)) (pi (run spec pi s (S k)))). now rewrite IH. }
  intros s V. split.
  - intros [e H]. revert V. induction H as [s e rest _ _ _ IH]. intros V. set (t := delta spec s (pi s)) in *.
    destruct (restored_dec spec s t) as [R|R]; [now exists 1|].
    assert (K : kept spec s t) by now apply (ok_delta spec order), keep.
    destruct (IH t eq_refl R (proj1 K)) as [k M]. exists (S k). rewrite later.
    apply (restored_later s t); [now apply kept_level | exact M].
  - intros [k R]. revert s V R. induction k as [|k IH]; intros s V R; [destruct R as [_ R]; cbn in R; lia|].
    set (t := delta spec s (pi s)). assert (K : kept spec s t) by now apply (ok_delta spec order), keep.
    assert (build : forall rest, (~ restored spec s t -> back_within spec (nominally spec) pi t rest) ->
      exists e, back_within spec (nominally spec) pi s e).
    { intros rest H. exists (longer spec (pi s) rest). apply back with (fun _ => rest).
      - efforts.
      - intros u _ _. efforts.
      - intros u -> N. now apply H. }
    destruct (restored_dec spec s t) as [now_|N]; [now apply (build no_effort)|].
    destruct (IH t (proj1 K)) as [e B]; [|now apply (build e)].
    rewrite later in R. fold t in R. destruct R as [W R]. split; [exact W|].
    unfold restored in N. assert (L := kept_level spec s t K). assert (~ level spec s < level spec t) by (intros M; now apply N; split; [apply K|]). lia.
Qed.

End Ways.

(** ** One step, one severity: no more than sections 3 and 5 say *)

Section OneStep.

Variables (spec : specification) (order : ordering) (pi : policy).

Context (one_step : restored_in spec = OneStep) (one_severity : length (state_rules spec) <= 1).

Lemma lone : alone spec = true.
Proof.
  unfold alone. rewrite one_step. destruct (state_rules spec) as [|tier [|]]; [reflexivity | reflexivity |].
  cbn in one_severity. lia.
Qed.

(** Conditions 5 and 6 of [ok]: every outcome is safe, and so is the nominal successor. *)
Theorem steps_safe : forall s A, valid spec s ->
  (forall t, next spec order s A t -> kept spec s t) <->
  (forall t, out spec order s A t -> safe spec t) /\ safe spec (delta spec s A).
Proof.
  intros s A V. split.
  - intros H. split; [intros t T|]; apply (alone_kept spec s _ lone V), H; [now left | now right].
  - intros [H D] t [T | ->]; apply (alone_kept spec s _ lone V); auto.
Qed.

Lemma run_safe : forall s k, keeps_ok spec order pi -> valid spec s -> safe spec (run spec pi s (S k)).
Proof.
  intros s k keep V. assert (go : forall t, valid spec t -> safe spec (delta spec t (pi t))).
  { intros t W. now apply (steps_safe t (pi t) W), keep. }
  induction k as [|k IH]; [now apply go | apply (go (run spec pi s (S k))), IH].
Qed.

(** Nothing is asked of the way to safety, and safe states need not be mentioned where a goal is met. *)
Theorem one_step_right :
  sound_and_complete spec order pi <->
  forall s, valid spec s -> action_set spec (pi s) /\ ok spec order s (pi s) /\
    exists k, 1 <= k /\ within_bound spec k /\ met spec s (pi s) (run spec pi s k).
Proof.
  split; intros H s V.
  - destruct (H s V) as (set & allowed & _ & k & P & W & _ & M). eauto 6.
  - destruct (H s V) as (set & allowed & k & P & W & M). split; [exact set|]. split; [exact allowed|]. split.
    + intros U. unfold restores. rewrite one_step. intros t T. apply kept_restored; auto. now apply (steps_kept _ _ _ _ allowed).
    + exists k. repeat (split; [assumption|]). split; [|exact M]. destruct k as [|k]; [lia|].
      apply run_safe; [intros u X; now apply H | exact V].
Qed.

Lemma cheaper_better : forall s A, valid spec s -> ~ safe spec s -> ok spec order s A -> ok spec order s (pi s) ->
  better spec order pi s A <-> (total_duration spec A < total_duration spec (pi s))%N.
Proof.
  intros s A V U allowed now.
  assert (once : forall B, ok spec order s B -> at_once spec order s B)
    by (intros B okB t T; apply kept_restored; auto; now apply (steps_kept _ _ _ _ okB)).
  assert (L := at_once_less spec order pi s (pi s) A (once _ now) (once _ allowed)). apply once in allowed, now.
  rewrite <- L. unfold better. rewrite one_step. split; [|tauto].
  intros [[_ H]|[[_ H]|[H _]]]; [contradiction | exact H | discriminate].
Qed.

(** [minimal] is about durations; *)
Theorem one_step_minimal : sound_and_complete spec order pi ->
  minimal spec order pi <->
  forall s A, valid spec s -> ~ safe spec s -> action_set spec A -> ok spec order s A ->
    (total_duration spec A < total_duration spec (pi s))%N -> ~ sound_and_complete spec order (change pi s A).
Proof.
  intros right. split; intros H s A V U set allowed cheap; apply (H s A V U set allowed);
    now apply (cheaper_better s A V U allowed (proj1 (proj2 (right s V)))).
Qed.

(** and only the run from the changed state matters: no cheaper allowed set has a run that, continued by the policy,
    meets its goal. *)
Theorem one_step_minimal_run : sound_and_complete spec order pi ->
  minimal spec order pi <->
  forall s A, valid spec s -> ~ safe spec s -> action_set spec A -> ok spec order s A ->
    (total_duration spec A < total_duration spec (pi s))%N -> ~ reaches spec pi s A.
Proof.
  intros right. rewrite (one_step_minimal right). assert (keep : keeps_ok spec order pi) by (intros s V; apply (right s V)).
  split; intros H s A V U set allowed cheap bad; apply (H s A V U set allowed cheap).
  - assert (keep' := change_ok spec order pi s A keep allowed). intros t W.
    assert (K : action_set spec (change pi s A t) /\ reaches spec pi t (change pi s A t)).
    { destruct (list_eq_dec Nat.eq_dec t s) as [->|differ]; [now rewrite change_here|].
      rewrite change_there by exact differ. split; [apply (right t W)|]. apply (reaches_own spec pi t). apply (right t W). }
    split; [apply K|]. split; [now apply keep'|]. split.
    + intros X. unfold restores. rewrite one_step. intros u T. apply kept_restored; auto.
      now apply (steps_kept _ _ _ _ (keep' t W)).
    + apply (reaches_own spec (change pi s A) t). apply (alone_reaches spec order pi s A t _ lone keep U W); [now apply keep'|].
      apply K.
  - assert (R := proj2 (reaches_own spec (change pi s A) s) (proj2 (proj2 (proj2 (bad s V))))). rewrite change_here in R.
    now apply (alone_reaches spec order pi s A s A lone keep U V allowed).
Qed.

End OneStep.
