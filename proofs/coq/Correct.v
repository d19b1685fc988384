(** The checker is right: it answers [true] exactly for the tables of sound, complete and minimal policies. *)

From Coq Require Import Bool List Arith NArith Lia Sorted.
From Tumato Require Import Semantics Checker Lists Steps Runs.
Import ListNotations.

Section Correctness.

Variables (spec : specification) (order : ordering).

Local Notation fine := (fine spec).
Local Notation fuel := (fuel spec).
Local Notation keeps_ok := (keeps_ok spec order).
Local Notation reaches := (reaches spec).

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
      unfold out. right. destruct order.
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
    + cbn [rev app] in H. rewrite (proj2 (is_ok_spec _ _ s B) allowed) in H.
      now rewrite (proj2 (serves_spec _ _ pi s B keep allowed) reach) in H.
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
    apply (assumed_spec _ s I) in V. now rewrite V in H.
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
  - intros [[[set allowed] serve] best]. apply (serves_spec _ _ _ _ _ keep allowed) in serve.
    split; [now exists A|]. repeat (split; [assumption|]). intros U. now destruct best.
  - intros (_ & set & allowed & reach & best). apply (serves_spec _ _ _ _ _ keep allowed) in reach.
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
    intros U B. now apply (proj1 (minimal_iff _ _ _ right) best).
Qed.

Theorem checker_sound : forall t, check spec order t = true ->
  sound_and_complete spec order (policy_of t) /\ minimal spec order (policy_of t).
Proof. intros t H. now apply checker_exact in H. Qed.

End Correctness.

Print Assumptions checker_exact.
Print Assumptions checker_sound.
