(** The theorem about the checker where there are starts, and what it says of steps. *)

From Coq Require Import Bool List.
From Tumato Require Import Semantics Checker Lists Steps Correct.
Import ListNotations.

Section Starts.

Variables (spec : specification) (order : ordering).

Lemma is_start_spec : forall s, valid spec s -> is_start spec s = true <-> start spec s.
Proof.
  intros s V. unfold is_start, start. destruct (starts spec) as [|f fs]; [tauto|].
  rewrite existsb_exists. split; [auto|]. intros [_ [none|some]]; [discriminate | exact some].
Qed.

Lemma within_state : forall D s, is_state (within spec D) s <-> is_state spec s.
Proof. reflexivity. Qed.

(** What is looked at within a part that holds valid states only: the states of the part. *)
Lemma within_valid : forall D, (forall s, is_state spec s -> D s = true -> valid spec s) ->
  forall s, valid (within spec D) s <-> is_state spec s /\ D s = true.
Proof.
  intros D inside s. split; [intros [I [_ P]]; now split|]. intros [I P]. destruct (inside s I P) as [_ [A _]].
  split; [exact I | split; [exact A | exact P]].
Qed.

Lemma decides_spec : forall t s, decides t s = true <-> exists A, lookup t s = Some (Some A).
Proof.
  intros t s. unfold decides, entry. destruct (lookup t s) as [[A|]|].
  - split; [now exists A | reflexivity].
  - split; [discriminate | now intros [A H]].
  - split; [discriminate | now intros [A H]].
Qed.

Theorem starts_exact : forall t known, check_from_starts spec order t known = true <->
  true_efforts (within spec (decides t)) order (policy_of t) known /\
  right_from_starts spec order (decides t) (policy_of t).
Proof.
  intros t known. unfold check_from_starts. eager. rewrite andb_true_iff, checker_exact, every_forallb, forallb_forall.
  assert (P : (forall s, In s (all_states (sizes spec)) ->
      (if assumed spec s then negb (is_start spec s) ||| decides t s else negb (decides t s)) = true) <->
    (forall s, start spec s -> decides t s = true) /\
    (forall s, is_state spec s -> decides t s = true -> valid spec s)).
  { split.
    - intros H. split; intros s.
      + intros S. assert (V := proj1 S). specialize (H s (proj2 (in_all_states _ _) (proj1 V))).
        rewrite (proj2 (assumed_spec spec s (proj1 V)) V), (proj2 (is_start_spec s V) S) in H. exact H.
      + intros I E. specialize (H s (proj2 (in_all_states _ _) I)). rewrite E in H.
        destruct (assumed spec s) eqn:A; [now apply assumed_spec | discriminate].
    - intros [all valid_only] s I. apply in_all_states in I. destruct (assumed spec s) eqn:A.
      + apply assumed_spec in A; [|exact I]. destruct (is_start spec s) eqn:S; [|reflexivity].
        cbn. apply all, is_start_spec; assumption.
      + destruct (decides t s) eqn:E; [|reflexivity]. apply valid_only in E; [|exact I].
        apply (assumed_spec spec s I) in E. congruence. }
  rewrite P. split.
  - intros [[all valid_only] (_ & told & right & best)]. split; [exact told|]. constructor; assumption.
  - intros [told [all valid_only right best]]. split; [now split|]. split; [|split; [exact told | now split]].
    intros s [_ [_ E]]. now apply decides_spec.
Qed.

Theorem starts_sound : forall t known, check_from_starts spec order t known = true ->
  right_from_starts spec order (decides t) (policy_of t).
Proof. intros t known H. now apply starts_exact in H. Qed.

Lemma struck_within : forall D A s t B, struck spec A s t B -> struck (within spec D) A s t B.
Proof. intros D A s t B H. induction H; [now apply last_effect | now apply next_effect with a e]. Qed.

Lemma next_within : forall D s A t, next spec order s A t -> next (within spec D) order s A t.
Proof.
  intros D s A t [[rest|[B H]]|H]; [left; left; exact rest | left; right; exists B | right; exact H].
  revert H. unfold after. destruct order; [apply struck_within | now intros H].
Qed.

(** No step of a right policy leaves what it decides. *)
Theorem stays_decided : forall D pi, right_from_starts spec order D pi ->
  forall s t, is_state spec s -> D s = true -> next spec order s (pi s) t -> is_state spec t /\ D t = true.
Proof.
  intros D pi [_ valid_only right _] s t I E N.
  destruct (right s (proj2 (within_valid D valid_only s) (conj I E))) as (_ & allowed & _).
  destruct (steps_kept _ _ _ _ allowed t (next_within D s (pi s) t N)) as [[J [_ F]] _]. now split.
Qed.

End Starts.

Print Assumptions starts_exact.
