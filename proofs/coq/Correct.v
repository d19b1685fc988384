(** The checker is right: it answers [true] exactly for the tables of sound, complete and minimal policies, with their
    efforts where restoring may take several steps. *)

From Coq Require Import Bool List Arith NArith Lia Sorted.
From Tumato Require Import Semantics Checker Lists Steps Runs Restoring Better.
Import ListNotations.

Section Correctness.

Variables (spec : specification) (order : ordering).

Local Notation valid_at := (valid_at spec).
Local Notation safe_at := (safe_at spec).
Local Notation kept_at := (kept_at spec).
Local Notation states := (states spec).
Local Notation fuel := (fuel spec).
Local Notation keeps_ok := (keeps_ok spec order).
Local Notation reaches := (reaches spec).

(** ** Better sets *)

Lemma all_cheaper_all : forall good cand, StronglySorted lt cand -> forall chosen budget,
  all_cheaper spec good cand chosen budget = true ->
  forall B, StronglySorted lt B -> incl B cand -> NoDup (rev chosen ++ B) ->
  (forall a b, In a (rev chosen ++ B) -> In b (rev chosen ++ B) -> a <> b -> compatible spec a b = true) ->
  (total_duration spec B < budget)%N -> good (rev chosen ++ B) = true.
Proof.
  intros good cand. induction 1 as [|a rest _ IH above]; cbn [all_cheaper]; intros chosen budget H B sorted inside nd comp cheap.
  - destruct B as [|b B]; [now rewrite app_nil_r | destruct (inside b (or_introl eq_refl))].
  - revert H. eager. rewrite andb_true_iff. intros [skip take].
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
  - eager. apply andb_true_iff. split.
    + apply IH; [exact some|]. intros B sorted inside. apply H; [exact sorted|]. now apply incl_tl.
    + destruct (_ && _) eqn:E; [|reflexivity]. apply andb_true_iff in E. destruct E as [E _]. apply N.ltb_lt in E.
      apply IH; [lia|]. intros B sorted inside cheap. cbn [rev]. rewrite <- app_assoc. apply H.
      * constructor; [exact sorted|]. rewrite Forall_forall in *. intros b Hb. now apply above, inside.
      * intros b [<-|Hb]; [now left | right; now apply inside].
      * change (total_duration spec ([a] ++ B)) with (duration (the spec a) + total_duration spec B)%N. lia.
Qed.

Lemma total_part : forall cand, StronglySorted lt cand -> forall B, StronglySorted lt B -> incl B cand ->
  (total_duration spec B <= total_duration spec cand)%N.
Proof.
  intros cand. induction 1 as [|a rest _ IH above]; intros B sorted inside.
  - destruct B as [|b B]; [reflexivity | destruct (inside b (or_introl eq_refl))].
  - change (total_duration spec (a :: rest)) with (duration (the spec a) + total_duration spec rest)%N.
    rewrite Forall_forall in above. destruct sorted as [|b B sorted after]; [cbn; lia|].
    rewrite Forall_forall in after.
    change (total_duration spec (b :: B)) with (duration (the spec b) + total_duration spec B)%N.
    destruct (inside b (or_introl eq_refl)) as [<-|Hb].
    + assert (L := IH B sorted). enough (I : incl B rest) by (specialize (L I); lia). intros c Hc.
      destruct (inside c (or_intror Hc)) as [<-|]; [|assumption]. apply after in Hc. lia.
    + enough (duration (the spec b) + total_duration spec B <= total_duration spec rest)%N by lia.
      apply (IH (b :: B)); [constructor; [exact sorted | now apply Forall_forall]|].
      intros c Hc. destruct (inside c Hc) as [<-|]; [|assumption]. exfalso. apply above in Hb.
      destruct Hc as [->|Hc]; [lia | apply after in Hc; lia].
Qed.

Lemma candidates_sorted : forall good s, StronglySorted lt (candidates spec good s).
Proof. intros good s. apply filter_sorted, seq_sorted. Qed.

Lemma ok_candidates : forall s A, valid spec s -> action_set spec A -> ok spec order s A ->
  incl A (candidates spec (kept_at s) s).
Proof.
  intros s A V [sorted declared_] allowed a Ha. apply filter_In. split.
  - apply in_seq. specialize (declared_ a Ha). lia.
  - eager. apply andb_true_iff. split.
    + apply all_hold_spec. now apply (preconditions_hold _ _ _ _ allowed).
    + apply one_good_spec. intros b e [<-|[]] He. apply kept_at_spec; [exact V|].
      apply (steps_kept _ _ _ _ allowed). left. right. exists (without a A). unfold after. destruct order.
      * now apply last_effect.
      * now exists a, e.
Qed.

Lemma ok_compatible : forall s A a b, ok spec order s A -> In a A -> In b A -> a <> b -> compatible spec a b = true.
Proof.
  intros s A a b allowed Ha Hb differ. apply andb_true_iff. split.
  - apply disjoint_spec. intros r. now apply (resources_differ _ _ _ _ allowed).
  - apply agree_spec. intros x v w. now apply (nominals_agree _ _ _ _ allowed).
Qed.

(** All runs of a policy meet their goals. *)
Definition serving (pi : policy) : Prop := forall t, valid spec t -> reaches pi t (pi t).

Section Policy.

Variables (pi : policy) (known : efforts).

Context (keep : keeps_ok pi).
Context (restoring : forall s, valid spec s -> ~ safe spec s ->
  is_restoring spec order valid_at known s (pi s) = true).
Context (serve : serving pi).

Local Notation no_better := (no_better spec order valid_at safe_at states fuel pi known).

Lemma no_better_spec : forall s, valid spec s -> ~ safe spec s ->
  no_better s (pi s) = true <->
  forall B, action_set spec B -> ok spec order s B -> better spec order pi s B -> ~ serving (change pi s B).
Proof.
  intros s V U. unfold Checker.no_better. set (A := pi s). cbv zeta. split.
  - intros H B set allowed best all. revert H. fold (kept_at s). eager. rewrite orb_true_iff.
    assert (B' := proj2 (is_better_spec spec order pi known keep restoring s B V U allowed) best). fold A in B'.
    assert (cheap : (total_duration spec B < if is_at_once spec order valid_at s A then total_duration spec A
      else 1 + total_duration spec (candidates spec (kept_at s) s))%N).
    { destruct (is_at_once spec order valid_at s A) eqn:O.
      - unfold is_better in B'. rewrite O in B'. destruct (is_at_once spec order valid_at s B); [|discriminate].
        now apply N.ltb_lt.
      - assert (L := total_part _ (candidates_sorted (kept_at s) s) B (proj1 set) (ok_candidates s B V set allowed)).
        lia. }
    intros [H|H]; [apply N.eqb_eq in H; lia|].
    apply (all_cheaper_all _ _ (candidates_sorted (kept_at s) s)) with (B := B) in H.
    + cbn [rev app] in H. rewrite (proj2 (is_ok_spec _ _ s B V) allowed), B' in H.
      now rewrite (proj2 (all_served_spec spec order pi s B keep V U allowed serve) all) in H.
    + apply set.
    + now apply ok_candidates.
    + apply sorted_nodup, set.
    + intros a b. now apply (ok_compatible s).
    + exact cheap.
  - intros H. fold (kept_at s). set (budget := if is_at_once _ _ _ _ _ then _ else _).
    eager. apply orb_true_iff. destruct (N.eqb_spec budget 0) as [|some]; [now left | right].
    apply all_cheaper_from; [apply candidates_sorted | lia|]. intros B sorted inside cheap. cbn [rev app].
    destruct (is_ok _ _ _ _ _) eqn:allowed; [|reflexivity]. apply is_ok_spec in allowed; [|exact V].
    destruct (is_better _ _ _ _ _ _) eqn:best; [|reflexivity].
    apply (is_better_spec spec order pi known keep restoring s B V U allowed) in best.
    apply negb_true_iff, not_true_iff_false. rewrite (all_served_spec spec order pi s B keep V U allowed serve).
    apply (H B); [|exact allowed | exact best].
    split; [exact sorted|]. intros a Ha. apply inside, filter_In in Ha. destruct Ha as [Ha _]. apply in_seq in Ha. lia.
Qed.

Lemma right_policy : (forall s, valid spec s -> action_set spec (pi s)) -> sound_and_complete spec order pi.
Proof.
  intros set s V. split; [now apply set|]. split; [now apply keep|]. split.
  - intros U. now apply (restoring_restores spec order pi known).
  - apply (reaches_own spec pi s). now apply serve.
Qed.

(** [minimal] in other words: with no better set do all runs still meet their goals. *)
Theorem minimal_iff : sound_and_complete spec order pi ->
  minimal spec order pi <->
  forall s B, valid spec s -> ~ safe spec s -> action_set spec B -> ok spec order s B -> better spec order pi s B ->
    ~ serving (change pi s B).
Proof.
  intros right. split; intros H s B V U set allowed best bad; apply (H s B V U set allowed best).
  - intros t W. assert (keep' := change_ok spec order pi s B keep allowed). split; [|split; [|split]].
    + destruct (list_eq_dec Nat.eq_dec t s) as [->|differ]; [now rewrite change_here|].
      rewrite change_there by exact differ. apply (right t W).
    + now apply keep'.
    + intros X. apply (is_better_spec spec order pi known keep restoring s B V U allowed) in best.
      now apply (better_restores spec order pi known keep restoring s B V U allowed best).
    + apply (reaches_own spec (change pi s B) t). now apply bad.
  - intros t W. apply (reaches_own spec (change pi s B) t). apply (bad t W).
Qed.

End Policy.

(** ** The theorem *)

(** Every valid state has an entry. *)
Definition total (t : table) : Prop := forall s, valid spec s -> exists A, lookup t s = Some (Some A).

Lemma is_action_set_spec : forall A, is_action_set spec A = true <-> action_set spec A.
Proof.
  intros A. unfold is_action_set, action_set. rewrite increasing_below_spec.
  split; intros [sorted bounds]; (split; [exact sorted|]); intros a Ha; specialize (bounds a Ha); lia.
Qed.

(** The efforts that are told are those that the policy takes: in each unsafe state the least one, where there is one. *)
Definition least (to : leads) (pi : policy) (told : state -> option effort) : Prop :=
  forall s, valid spec s -> ~ safe spec s -> match told s with
    | Some w => (1 <= snd w)%N /\ back_within spec to pi s w /\ forall e, back_within spec to pi s e -> at_most w e
    | None => forall e, ~ back_within spec to pi s e
    end.

Definition true_efforts (pi : policy) (known : efforts) : Prop :=
  (restored_in spec <> OneStep -> least (next spec order) pi (entry (worst known))) /\
  (restored_in spec = Fair -> least (nominally spec) pi (entry (nominal_sum known))).

Lemma told_true : forall pi (to : leads) along told, keeps_ok pi ->
  (forall fine s A, along fine s A = true <-> forall t, to s A t -> fine t = true) ->
  (forall s A t, to s A t -> next spec order s A t) -> all_told spec pi along told <-> least to pi told.
Proof.
  intros pi to along told keep along_spec to_next. split.
  - intros telling s V U. destruct (told s) as [w|] eqn:E.
    + split; [now apply (told_steps spec pi to along told along_spec telling s)|].
      split; [now apply (told_back spec order pi keep to along told along_spec to_next telling)|].
      intros e B. destruct (told_least spec order pi keep to along told along_spec to_next telling s e B V U) as [v [F L]].
      congruence.
    + intros e B. destruct (told_least spec order pi keep to along told along_spec to_next telling s e B V U) as [v [F _]].
      congruence.
  - now apply (least_told spec order).
Qed.

Lemma restoring_spec : forall pi known, keeps_ok pi ->
  (forall s, valid spec s -> ~ safe spec s -> is_restoring spec order valid_at known s (pi s) = true) <->
  true_efforts pi known /\ forall s, valid spec s -> ~ safe spec s -> restores spec order pi s.
Proof.
  intros pi known keep.
  assert (W := told_true pi (next spec order) (next_fine spec order) (entry (worst known)) keep
    (next_fine_spec spec order) (fun _ _ _ n => n)).
  assert (M := told_true pi (nominally spec) (nominally_fine spec) (entry (nominal_sum known)) keep
    (nominally_fine_spec spec) (nominally_next spec order)).
  split.
  - intros H. split; [split|].
    + intros stepwise. apply W. exact (told_worst spec order pi known H stepwise).
    + intros fair. apply M. exact (told_sum spec order pi known H fair).
    + now apply (restoring_restores spec order pi known).
  - intros [[TW TM] R] s V U. specialize (R s V U). unfold restores in R. unfold is_restoring.
    destruct (restored_in spec) eqn:O; [reflexivity | |].
    + specialize (TW ltac:(discriminate)). eager. apply andb_true_iff. split; [|now apply W].
      destruct R as [e B]. specialize (TW s V U). destruct (entry (worst known) s); [reflexivity | now apply TW in B].
    + specialize (TW ltac:(discriminate)). specialize (TM eq_refl). eager. rewrite !andb_true_iff.
      split; [split|]; [| now apply M | now apply W].
      destruct R as [e B]. specialize (TM s V U). destruct (entry (nominal_sum known) s); [reflexivity | now apply TM in B].
Qed.

(** What the checker says of a state. *)
Definition passes (t : table) (known : efforts) (s : state) : Prop :=
  exists A, lookup t s = Some (Some A) /\ check_state spec order valid_at safe_at states fuel (policy_of t) known s A = true.

Lemma check_spec : forall t known, check spec order t known = true <-> forall s, valid spec s -> passes t known s.
Proof.
  intros t known. unfold check. cbv zeta. rewrite forallb_forall. split; intros H s.
  - intros V. specialize (H s (proj2 (in_all_states _ _) (proj1 V))).
    apply (assumed_spec _ s (proj1 V)) in V. rewrite V in H. unfold entry in H. unfold passes.
    destruct (lookup t s) as [[A|]|]; [|discriminate..]. now exists A.
  - intros I. apply in_all_states in I. destruct (assumed spec s) eqn:E; [|reflexivity].
    apply (assumed_spec _ s I) in E. destruct (H s E) as [A [L C]]. cbn. unfold entry. rewrite L. exact C.
Qed.

Lemma passes_spec : forall t known s, passes t known s <->
  (exists A, lookup t s = Some (Some A)) /\ check_state spec order valid_at safe_at states fuel (policy_of t) known s (policy_of t s) = true.
Proof.
  intros t known s. unfold passes, policy_of at 3. split.
  - intros [A [L C]]. rewrite L. split; [now exists A | exact C].
  - intros [[A L] C]. rewrite L in C. now exists A.
Qed.

Lemma check_state_spec : forall pi known s, keeps_ok pi -> valid spec s ->
  check_state spec order valid_at safe_at states fuel pi known s (pi s) = true <->
  action_set spec (pi s) /\ ok spec order s (pi s) /\ reaches pi s (pi s) /\
  (~ safe spec s -> is_restoring spec order valid_at known s (pi s) = true /\
    no_better spec order valid_at safe_at states fuel pi known s (pi s) = true).
Proof.
  intros pi known s keep V. unfold check_state. fold (kept_at s). eager.
  rewrite !andb_true_iff, orb_true_iff, andb_true_iff, is_action_set_spec, is_ok_spec, safe_at_spec by exact V.
  rewrite (serves_spec spec order pi s (pi s) keep (keep s V)). split.
  - intros [[[set allowed] serve] best]. repeat (split; [assumption|]). intros U. now destruct best.
  - intros (set & allowed & serve & best). split; [auto|]. destruct (safe_at s) eqn:F; [left; now apply safe_at_spec | right].
    apply best. rewrite <- safe_at_spec, F. discriminate.
Qed.

Theorem checker_exact : forall t known, check spec order t known = true <->
  total t /\ true_efforts (policy_of t) known /\
  sound_and_complete spec order (policy_of t) /\ minimal spec order (policy_of t).
Proof.
  intros t known. rewrite check_spec. set (pi := policy_of t). split.
  - intros H. assert (K := fun s V => proj1 (passes_spec t known s) (H s V)). fold pi in K.
    assert (keep : keeps_ok pi).
    { intros s V. destruct (K s V) as [_ C]. unfold check_state in C. revert C. fold (kept_at s). eager.
      rewrite !andb_true_iff. intros [[[_ C] _] _]. now apply is_ok_spec. }
    assert (L := fun s V => proj1 (check_state_spec pi known s keep V) (proj2 (K s V))).
    assert (restoring : forall s, valid spec s -> ~ safe spec s -> is_restoring spec order valid_at known s (pi s) = true)
      by (intros s V U; now apply (L s V)).
    assert (serve : serving pi) by (intros s V; now apply (L s V)).
    assert (right : sound_and_complete spec order pi)
      by (apply (right_policy pi known keep restoring serve); intros s V; now apply (L s V)).
    split; [intros s V; apply (K s V)|]. split; [now apply restoring_spec|]. split; [exact right|].
    apply (minimal_iff pi known keep restoring right). intros s B V U.
    apply (no_better_spec pi known keep restoring serve s V U). now apply (L s V).
  - intros (entries & told & right & best) s V. apply passes_spec. split; [now apply entries|]. fold pi.
    assert (keep : keeps_ok pi) by (intros u W; apply (right u W)).
    assert (serve : serving pi) by (intros u W; apply (reaches_own spec pi u); apply (right u W)).
    assert (restoring : forall s, valid spec s -> ~ safe spec s -> is_restoring spec order valid_at known s (pi s) = true)
      by (apply restoring_spec; [exact keep | split; [exact told | intros u W; apply (right u W)]]).
    apply check_state_spec; [exact keep | exact V|]. split; [apply (right s V)|]. split; [now apply keep|].
    split; [now apply serve|]. intros U. split; [now apply restoring|].
    apply (no_better_spec pi known keep restoring serve s V U). intros B.
    now apply (proj1 (minimal_iff pi known keep restoring right) best).
Qed.

Theorem checker_sound : forall t known, check spec order t known = true ->
  sound_and_complete spec order (policy_of t) /\ minimal spec order (policy_of t).
Proof. intros t known H. now apply checker_exact in H. Qed.

End Correctness.

Print Assumptions checker_exact.
Print Assumptions checker_sound.
