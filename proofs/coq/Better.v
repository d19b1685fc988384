(** The checker's answers about sets that restore better. *)

From Coq Require Import Bool List Arith NArith Lia.
From Tumato Require Import Semantics Checker Lists Steps Runs Restoring.
Import ListNotations.

Section Better.

Variables (spec : specification) (order : ordering) (pi : policy) (known : efforts).

Context (keep : keeps_ok spec order pi).

Local Notation next := (next spec order).
Local Notation nominally := (nominally spec).
Local Notation valid_at := (valid_at spec).
Local Notation along_next := (next_fine spec order).
Local Notation along_nominal := (nominally_fine spec).
Local Notation longest := (entry (worst known)).
Local Notation sum := (entry (nominal_sum known)).
Local Notation is_restoring := (is_restoring spec order valid_at known).
Local Notation is_at_once := (is_at_once spec order valid_at).

Context (restoring : forall s, valid spec s -> ~ safe spec s -> is_restoring s (pi s) = true).

Lemma nominally_next : forall s A t, nominally s A t -> next s A t.
Proof. intros s A t ->. now right. Qed.

Lemma told_worst : restored_in spec <> OneStep -> all_told spec pi along_next longest.
Proof.
  intros stepwise s V U. assert (H := restoring s V U). unfold Checker.is_restoring in H.
  destruct (restored_in spec); [contradiction | |]; revert H; eager; rewrite !andb_true_iff; tauto.
Qed.

Lemma told_sum : restored_in spec = Fair -> all_told spec pi along_nominal sum.
Proof.
  intros fair s V U. assert (H := restoring s V U). unfold Checker.is_restoring in H. rewrite fair in H.
  revert H. eager. rewrite !andb_true_iff. tauto.
Qed.

Lemma decided_some : forall e, decided e = true -> exists w, e = Some w.
Proof. intros [w|]; [now exists w | discriminate]. Qed.

Lemma has_worst : restored_in spec = Bounded -> forall s, valid spec s -> ~ safe spec s -> exists w, longest s = Some w.
Proof.
  intros bounded s V U. assert (H := restoring s V U). unfold Checker.is_restoring in H. rewrite bounded in H.
  revert H. eager. rewrite andb_true_iff. intros [D _]. now apply decided_some.
Qed.

Lemma has_sum : restored_in spec = Fair -> forall s, valid spec s -> ~ safe spec s -> exists w, sum s = Some w.
Proof.
  intros fair s V U. assert (H := restoring s V U). unfold Checker.is_restoring in H. rewrite fair in H.
  revert H. eager. rewrite !andb_true_iff. intros [[D _] _]. now apply decided_some.
Qed.

Lemma at_once_spec : forall s A, valid spec s -> ~ safe spec s -> ok spec order s A ->
  is_at_once s A = true <-> at_once spec order s A.
Proof.
  intros s A V U allowed. unfold Checker.is_at_once, at_once.
  assert (K : next_fine spec order (is_restored spec valid_at s) s A = true <-> forall t, next s A t -> restored spec s t).
  { rewrite next_fine_spec. unfold is_restored. split; intros H t N.
    - destruct (proj1 (back_spec _ _ _ _ _) (H t N)) as [R|[e [E _]]]; [exact R | discriminate].
    - apply back_spec. left. now apply H. }
  destruct (restored_in spec) eqn:O; [|exact K ..]. split; [|reflexivity]. intros _ t N.
  apply kept_restored; auto. now apply (steps_kept _ _ _ _ allowed).
Qed.

(** The lemmas of [Restoring.v], about the worst case and about what is nominal. *)

Lemma worst_told_back : restored_in spec <> OneStep -> forall w s, valid spec s -> ~ safe spec s ->
  longest s = Some w -> back_within spec next pi s w.
Proof.
  intros stepwise. apply (told_back _ order pi keep next along_next longest (next_fine_spec spec order)); auto.
  now apply told_worst.
Qed.

Lemma sum_told_back : restored_in spec = Fair -> forall w s, valid spec s -> ~ safe spec s ->
  sum s = Some w -> back_within spec nominally pi s w.
Proof.
  intros fair. apply (told_back _ order pi keep nominally along_nominal sum (nominally_fine_spec spec) nominally_next).
  now apply told_sum.
Qed.

Lemma less_worst : restored_in spec <> OneStep -> forall s B w, valid spec s -> ~ safe spec s -> ok spec order s B ->
  longest s = Some w ->
  less_effort spec next pi s B (pi s) <-> takes spec valid_at less longest along_next s B w = true.
Proof.
  intros stepwise. apply (less_told _ order pi keep next along_next longest (next_fine_spec spec order)); auto.
  now apply told_worst.
Qed.

Lemma less_sum : restored_in spec = Fair -> forall s B w, valid spec s -> ~ safe spec s -> ok spec order s B ->
  sum s = Some w ->
  less_effort spec nominally pi s B (pi s) <-> takes spec valid_at less sum along_nominal s B w = true.
Proof.
  intros fair. apply (less_told _ order pi keep nominally along_nominal sum (nominally_fine_spec spec) nominally_next).
  now apply told_sum.
Qed.

Lemma ends_worst : restored_in spec <> OneStep -> forall s A, valid spec s -> ~ safe spec s -> ok spec order s A ->
  ends spec valid_at longest along_next s A = true <-> finite spec order pi s A.
Proof.
  intros stepwise. apply (ends_after _ order pi keep next along_next longest (next_fine_spec spec order)); auto.
  now apply told_worst.
Qed.

Lemma untold_worst : restored_in spec <> OneStep -> forall s, valid spec s -> ~ safe spec s -> longest s = None ->
  ~ finite spec order pi s (pi s).
Proof.
  intros stepwise. apply (infinite_untold _ order pi keep next along_next longest (next_fine_spec spec order)); auto.
  now apply told_worst.
Qed.

(** What a policy has to do in an unsafe state is there. *)
Lemma restoring_restores : forall s, valid spec s -> ~ safe spec s -> restores spec order pi s.
Proof.
  intros s V U. unfold restores. destruct (restored_in spec) eqn:O.
  - intros t N. apply kept_restored; auto. now apply (steps_kept _ _ _ _ (keep s V)).
  - destruct (has_worst O s V U) as [w E]. exists w. apply worst_told_back; auto. congruence.
  - destruct (has_sum O s V U) as [w E]. exists w. now apply sum_told_back.
Qed.

Section Rival.

Variables (s : state) (B : actions).

Context (V : valid spec s).
Context (U : ~ safe spec s).
Context (allowed : ok spec order s B).

Lemma at_once_finite : forall A, at_once spec order s A -> finite spec order pi s A.
Proof.
  intros A once. exists (longer spec A no_effort). apply at_once_after; [exact once | efforts].
Qed.

Lemma is_better_spec : is_better spec order valid_at known s (pi s) B = true <-> better spec order pi s B.
Proof.
  unfold is_better, better. set (A := pi s).
  assert (K := at_once_spec s A V U (keep s V)). assert (L := at_once_spec s B V U allowed).
  assert (stepwise : is_at_once s A = false \/ is_at_once s B = false -> restored_in spec <> OneStep).
  { unfold Checker.is_at_once. intros H O. rewrite O in H. destruct H; discriminate. }
  destruct (is_at_once s B), (is_at_once s A).
  - assert (onceA : at_once spec order s A) by now apply K. assert (onceB : at_once spec order s B) by now apply L.
    rewrite N.ltb_lt, <- (at_once_less spec order pi s A B onceA onceB). split; [tauto|].
    intros [[_ H]|[[_ H]|[_ [H _]]]]; [contradiction | exact H | now apply at_once_finite in onceB].
  - split; [intros _; left; rewrite <- L, <- K; split; [reflexivity | discriminate] | reflexivity].
  - assert (onceA : at_once spec order s A) by now apply K.
    split; [discriminate|]. intros [[_ H]|[[H _]|[_ [_ [H _]]]]]; [contradiction | | now apply at_once_finite in onceA].
    rewrite <- L, <- K in H. now apply H.
  - specialize (stepwise (or_introl eq_refl)).
    assert (same : at_once spec order s B <-> at_once spec order s A) by (rewrite <- L, <- K; tauto).
    assert (notB : ~ at_once spec order s B) by (rewrite <- L; discriminate).
    destruct (longest s) as [w|] eqn:E.
    + rewrite <- (less_worst stepwise s B w V U allowed E). split; [tauto|].
      intros [[H _]|[[_ H]|[_ [_ [H _]]]]]; [contradiction | exact H |]. exfalso. apply H. exists w.
      apply back_within_after. now apply worst_told_back.
    + assert (infinite : ~ finite spec order pi s A) by now apply untold_worst.
      assert (ending := ends_worst stepwise s B V U allowed).
      assert (fair : restored_in spec = Fair).
      { destruct (restored_in spec) eqn:O; [contradiction | | reflexivity].
        destruct (has_worst O s V U). congruence. }
      destruct (has_sum fair s V U) as [f F]. rewrite F.
      destruct (ends spec valid_at longest along_next s B).
      * split; [intros _ | reflexivity]. right. left. split; [exact same|].
        destruct (proj1 ending eq_refl) as [e H]. exists e. split; [exact H|]. intros H'. apply infinite. now exists e.
      * assert (infiniteB : ~ finite spec order pi s B) by (intros H; apply ending in H; discriminate).
        rewrite <- (less_sum fair s B f V U allowed F). split; [tauto|]. intros [[H _]|[[_ [e [H _]]]|H]]; [contradiction | | apply H].
        exfalso. apply infiniteB. now exists e.
Qed.

(** What restores better in [s] takes restoring from no other state. *)
Lemma better_restores : is_better spec order valid_at known s (pi s) B = true ->
  forall t, valid spec t -> ~ safe spec t -> restores spec order (change pi s B) t.
Proof.
  intros H t V' U'. set (keep' := change_ok spec order pi s B keep allowed).
  assert (worst_back : restored_in spec <> OneStep -> forall c,
    (forall w, longest s = Some w -> back_within spec next (change pi s B) s c \/
      c = no_effort /\ takes spec valid_at less longest along_next s B w = true) ->
    forall w u, valid spec u -> ~ safe spec u -> longest u = Some w -> back_within spec next (change pi s B) u (plus w c)).
  { intros stepwise c now. apply (changed_back _ order pi keep next along_next longest (next_fine_spec spec order)); auto.
    now apply told_worst. }
  assert (once : is_at_once s B = true -> back_within spec next (change pi s B) s (longer spec B no_effort)).
  { intros O. apply (at_once_spec s B V U allowed) in O. apply back_within_after. rewrite change_here.
    apply at_once_after; [exact O | efforts]. }
  unfold restores. destruct (restored_in spec) eqn:O.
  - intros u N. apply kept_restored; auto. now apply (steps_kept _ _ _ _ (keep' t V')).
  - assert (stepwise : Bounded <> OneStep) by discriminate.
    destruct (has_worst O t V' U') as [w E]. unfold is_better in H. destruct (is_at_once s B).
    + eexists. apply worst_back with (c := longer spec B no_effort) (w := w); auto.
    + destruct (is_at_once s (pi s)); [discriminate|]. destruct (has_worst O s V U) as [v F]. rewrite F in H.
      eexists. apply worst_back with (c := no_effort) (w := w); auto.
      intros v' F'. right. split; [reflexivity | congruence].
  - assert (stepwise : Fair <> OneStep) by discriminate.
    destruct (has_sum O t V' U') as [w E].
    assert (nominal_back : forall c, back_within spec nominally (change pi s B) s c \/
      c = no_effort /\ (exists v, sum s = Some v /\ takes spec valid_at less sum along_nominal s B v = true) ->
      exists e, back_within spec nominally (change pi s B) t e).
    { intros c now. exists (plus w c).
      apply (changed_back _ order pi keep nominally along_nominal sum (nominally_fine_spec spec) nominally_next
        (told_sum O) s B c V U allowed); auto.
      intros v F. destruct now as [now|[-> [v' [F' T]]]]; [now left | right]. split; [reflexivity | congruence]. }
    unfold is_better in H. destruct (is_at_once s B).
    { apply (nominal_back (longer spec B no_effort)). left. now apply (back_nominally _ order), once. }
    destruct (is_at_once s (pi s)); [discriminate|]. destruct (longest s) as [v|] eqn:F.
    { apply (nominal_back (plus v no_effort)). left. apply (back_nominally _ order), worst_back; auto.
      intros v' F'. right. split; [reflexivity | congruence]. }
    destruct (has_sum O s V U) as [v G]. rewrite G in H.
    destruct (ends spec valid_at longest along_next s B) eqn:N.
    + destruct (bounded spec B longest (states spec)) as [e [M K]].
      apply (nominal_back e). left. apply (back_nominally _ order).
      apply back with (fun u => plus (said longest u) no_effort); rewrite change_here; [exact M | |];
        intros u T R; apply (proj1 (ends_spec _ next along_next longest (next_fine_spec spec order) s B) N u T) in R as G';
        destruct G' as [f G']; destruct (unsafe_after spec order next (fun _ _ _ n => n) s B u V U allowed T R) as [W' X'].
      * unfold said. rewrite G'. assert (I : In u (states spec)) by (apply in_all_states, W').
        specialize (K u f I G'). unfold plus. efforts.
      * unfold said. rewrite G'. apply worst_back; auto. intros v' F'. congruence.
    + apply (nominal_back no_effort). right. split; [reflexivity | now exists v].
Qed.

End Rival.

End Better.
