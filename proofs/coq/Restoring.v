(** The checker's answers about how safety is restored: the efforts that are told are the least ones. *)

From Coq Require Import Bool List Arith NArith Lia.
From Tumato Require Import Semantics Checker Lists Steps Runs.
Import ListNotations.

(** ** Efforts *)

Ltac efforts := unfold at_most, longer, no_effort in *; cbn [fst snd] in *; lia.

Lemma effort_ind : forall P : effort -> Prop,
  (forall w, (forall f, ~ at_most w f -> P f) -> P w) -> forall w, P w.
Proof.
  intros P H [D K]. revert K. induction D as [D IHD] using (well_founded_induction N.lt_wf_0).
  intros K. induction K as [K IHK] using (well_founded_induction N.lt_wf_0).
  apply H. intros [D' K'] small. unfold at_most in small. cbn in small.
  destruct (N.eq_dec D' D) as [->|differ]; [apply IHK; lia | apply IHD; lia].
Qed.

(** The greatest effort that is less than one of at least one step. *)
Definition before (w : effort) : effort := (fst w, snd w - 1)%N.

Lemma before_spec : forall e w, (1 <= snd w)%N -> at_most e (before w) <-> ~ at_most w e.
Proof. intros e w H. unfold before. efforts. Qed.

Definition plus (e f : effort) : effort := (fst e + fst f, snd e + snd f)%N.

Section Restoring.

Variables (spec : specification) (order : ordering) (pi : policy).

Context (keep : keeps_ok spec order pi).

Local Notation longer := (longer spec).
Local Notation restored := (restored spec).
Local Notation is_back := (is_back spec (valid_at spec)).
Local Notation states := (states spec).

Lemma back_spec : forall told s good t,
  is_back told s good t = true <-> restored s t \/ exists e, told t = Some e /\ good e = true.
Proof.
  intros told s good t. unfold Checker.is_back, Semantics.restored. cbv zeta. eager.
  rewrite orb_true_iff, andb_true_iff, valid_at_spec, Nat.ltb_lt. split; (intros [H|H]; [now left | right]).
  - destruct (told t) as [e|]; [now exists e | discriminate].
  - destruct H as [e [-> H]]. exact H.
Qed.

Lemma restored_dec : forall s t, {restored s t} + {~ restored s t}.
Proof.
  intros s t. destruct (is_back (fun _ => None) s (fun _ => true) t) eqn:E; [left | right].
  - apply back_spec in E. now destruct E as [E|[e [E _]]].
  - intros R. apply not_true_iff_false in E. apply E, back_spec. now left.
Qed.

Lemma bounded : forall A (told : state -> option effort) l, exists e, at_most (longer A no_effort) e /\
  forall t f, In t l -> told t = Some f -> at_most (longer A f) e.
Proof.
  intros A told l. induction l as [|t l [e [N H]]]; [exists (longer A no_effort); split; [efforts | contradiction]|].
  destruct (told t) as [f|] eqn:E.
  - exists (plus e (longer A f)). unfold plus. split; [efforts|].
    intros u g [<-|I] T; [rewrite E in T; injection T as <- | specialize (H u g I T)]; efforts.
  - exists e. split; [exact N|]. intros u g [<-|I] T; [congruence | now apply (H u)].
Qed.

Lemma at_once_after : forall s A e, at_once spec order s A ->
  back_after spec (next spec order) pi s A e <-> at_most (longer A no_effort) e.
Proof.
  intros s A e once. split; [now intros [rest [H _]]|]. intros H. exists (fun _ => no_effort). split; [exact H|].
  intros t N R. now apply once in N.
Qed.

Lemma at_once_less : forall s A B, at_once spec order s A -> at_once spec order s B ->
  less_effort spec (next spec order) pi s B A <-> (total_duration spec B < total_duration spec A)%N.
Proof.
  intros s A B onceA onceB. unfold less_effort. split.
  - intros [e [H N]]. apply (at_once_after s B e onceB) in H. rewrite (at_once_after s A e onceA) in N. efforts.
  - intros H. exists (longer B no_effort). rewrite !at_once_after by assumption. efforts.
Qed.

Lemma back_within_after : forall to s e, back_within spec to pi s e <-> back_after spec to pi s (pi s) e.
Proof.
  intros to s e. split.
  - intros H. destruct H as [s e rest N M H]. exists rest. auto.
  - intros (rest & N & H). apply back with rest; [exact N | |]; intros t T R; now apply H.
Qed.

Lemma back_within_more : forall to p s e f, back_within spec to p s e -> at_most e f -> back_within spec to p s f.
Proof.
  intros to p s e f H. destruct H as [s e rest N M B]. intros L.
  apply back with rest; [efforts | | exact B]. intros t T R. specialize (M t T R). efforts.
Qed.

Lemma back_nominally : forall p s e, back_within spec (next spec order) p s e -> back_within spec (nominally spec) p s e.
Proof.
  intros p s e H. induction H as [s e rest N M _ IH].
  apply back with rest; [exact N | |]; intros t -> R; [apply M | apply IH]; auto; now right.
Qed.

(** ** What is told, for all states or for the nominal successors *)

Section Told.

Variables (to : leads) (along : fine_along) (told : state -> option effort).

Context (along_spec : forall fine s A, along fine s A = true <-> forall t, to s A t -> fine t = true).
Context (to_next : forall s A t, to s A t -> next spec order s A t).

Definition all_told : Prop := forall s, valid spec s -> ~ safe spec s ->
  is_told spec (valid_at spec) told along s (pi s) = true.

Local Notation takes compare := (takes spec (valid_at spec) compare told along).
Local Notation ends := (ends spec (valid_at spec) told along).
Local Notation back_within := (back_within spec to).
Local Notation back_after := (back_after spec to).

Lemma takes_spec : forall compare s A l, takes compare s A l = true <->
  compare (longer A no_effort) l = true /\
  forall t, to s A t -> ~ restored s t -> exists f, told t = Some f /\ compare (longer A f) l = true.
Proof.
  intros compare s A l. unfold Checker.takes. eager. rewrite andb_true_iff, along_spec.
  split; (intros [N H]; split; [exact N|]); intros t T.
  - intros R. destruct (proj1 (back_spec _ _ _ _) (H t T)) as [R'|E]; [contradiction | exact E].
  - apply back_spec. destruct (restored_dec s t) as [R|R]; [now left | right; now apply H].
Qed.

Lemma ends_spec : forall s A, ends s A = true <->
  forall t, to s A t -> ~ restored s t -> exists f, told t = Some f.
Proof.
  intros s A. unfold Checker.ends. rewrite along_spec. split; intros H t T.
  - intros R. destruct (proj1 (back_spec _ _ _ _) (H t T)) as [R'|[f [E _]]]; [contradiction | now exists f].
  - apply back_spec. destruct (restored_dec s t) as [R|R]; [now left | right].
    destruct (H t T R) as [f E]. now exists f.
Qed.

Lemma unsafe_after : forall s A t, valid spec s -> ~ safe spec s -> ok spec order s A -> to s A t -> ~ restored s t ->
  valid spec t /\ ~ safe spec t.
Proof.
  intros s A t V U allowed T R. assert (W : valid spec t) by (apply (ok_next spec order s A); auto).
  split; [exact W | now apply (restored_unsafe spec s)].
Qed.

Section Exact.

Context (telling : all_told).

Lemma told_steps : forall s w, valid spec s -> ~ safe spec s -> told s = Some w -> (1 <= snd w)%N.
Proof.
  intros s w V U E. assert (H := telling s V U). unfold is_told in H. rewrite E in H. revert H. eager.
  rewrite andb_true_iff, negb_true_iff. intros [M L]. destruct (N.eq_dec (snd w) 0) as [zero|]; [exfalso | lia].
  apply not_true_iff_false in L. apply L. apply takes_spec in M. apply takes_spec. destruct M as [N M].
  assert (sharp : forall e, not_more (longer (pi s) e) w = true -> less (longer (pi s) e) w = true).
  { intros e. rewrite not_more_spec, less_spec. efforts. }
  split; [now apply sharp|]. intros t T R. destruct (M t T R) as [f [F G]]. exists f. split; [exact F | now apply sharp].
Qed.

Lemma told_least : forall s e, back_within pi s e -> valid spec s -> ~ safe spec s ->
  exists w, told s = Some w /\ at_most w e.
Proof.
  intros s e H. induction H as [s e rest N M _ IH]. intros V U.
  assert (after : forall t, to s (pi s) t -> ~ restored s t -> exists f, told t = Some f /\ at_most (longer (pi s) f) e).
  { intros t T R. destruct (unsafe_after s _ t V U (keep s V) T R) as [V' U'].
    destruct (IH t T R V' U') as [f [E L]]. exists f. split; [exact E|]. specialize (M t T R). efforts. }
  assert (H := telling s V U). unfold is_told in H. destruct (told s) as [w|].
  - exists w. split; [reflexivity|]. revert H. eager. rewrite andb_true_iff, negb_true_iff. intros [_ H].
    destruct (not_more w e) eqn:L; [now apply not_more_spec|]. exfalso.
    apply not_true_iff_false in H, L. rewrite not_more_spec in L. apply H, takes_spec.
    split; [apply less_spec; efforts|]. intros t T R. destruct (after t T R) as [f [E F]].
    exists f. split; [exact E|]. apply less_spec. efforts.
  - exfalso. apply negb_true_iff, not_true_iff_false in H. apply H, ends_spec.
    intros t T R. destruct (after t T R) as [f [E _]]. now exists f.
Qed.

Lemma told_takes : forall s w, valid spec s -> ~ safe spec s -> told s = Some w -> takes not_more s (pi s) w = true.
Proof.
  intros s w V U E. assert (H := telling s V U). unfold is_told in H. rewrite E in H. revert H. eager.
  now rewrite andb_true_iff.
Qed.

Definition said (t : state) : effort := match told t with Some f => f | None => no_effort end.

Lemma told_back : forall w s, valid spec s -> ~ safe spec s -> told s = Some w -> back_within pi s w.
Proof.
  intros w. induction w as [w IH] using effort_ind. intros s V U E.
  destruct (proj1 (takes_spec _ _ _ _) (told_takes s w V U E)) as [N M]. rewrite not_more_spec in N.
  apply back with said; [exact N | |].
  all: intros t T R; destruct (M t T R) as [f [F L]]; rewrite not_more_spec in L; unfold said; rewrite F.
  - exact L.
  - destruct (unsafe_after s _ t V U (keep s V) T R) as [V' U']. apply IH; auto. efforts.
Qed.

Lemma takes_after : forall s A w, valid spec s -> ~ safe spec s -> ok spec order s A -> (1 <= snd w)%N ->
  takes less s A w = true <-> exists e, ~ at_most w e /\ back_after pi s A e.
Proof.
  intros s A w V U allowed some. rewrite takes_spec. split.
  - intros [N M]. exists (before w). split; [apply before_spec; [exact some | efforts]|].
    exists said. rewrite less_spec in N. split; [now apply before_spec|].
    intros t T R. destruct (M t T R) as [f [F L]]. rewrite less_spec in L. unfold said. rewrite F.
    split; [now apply before_spec|]. destruct (unsafe_after s _ t V U allowed T R) as [V' U']. now apply told_back.
  - intros [e [L (rest & N & M)]]. split; [apply less_spec; efforts|]. intros t T R.
    destruct (unsafe_after s _ t V U allowed T R) as [V' U']. destruct (M t T R) as [K B].
    destruct (told_least t _ B V' U') as [f [F G]]. exists f. split; [exact F|]. apply less_spec. efforts.
Qed.

Lemma less_told : forall s A w, valid spec s -> ~ safe spec s -> ok spec order s A -> told s = Some w ->
  less_effort spec to pi s A (pi s) <-> takes less s A w = true.
Proof.
  intros s A w V U allowed E. rewrite (takes_after s A w V U allowed (told_steps s w V U E)). unfold less_effort.
  assert (K : forall e, back_after pi s (pi s) e <-> at_most w e).
  { intros e. rewrite <- back_within_after. split.
    - intros B. destruct (told_least s e B V U) as [v [F L]]. congruence.
    - now apply back_within_more, told_back. }
  split; intros [e H]; exists e; rewrite K in *; tauto.
Qed.

Lemma ends_after : forall s A, valid spec s -> ~ safe spec s -> ok spec order s A ->
  ends s A = true <-> exists e, back_after pi s A e.
Proof.
  intros s A V U allowed. rewrite ends_spec. split.
  - intros H. destruct (bounded A told states) as [e [N M]]. exists e, said. split; [exact N|].
    intros t T R. destruct (H t T R) as [f F]. unfold said. rewrite F.
    destruct (unsafe_after s _ t V U allowed T R) as [V' U'].
    split; [apply (M t); [apply in_all_states, V' | exact F] | now apply told_back].
  - intros [e (rest & _ & M)] t T R. destruct (unsafe_after s _ t V U allowed T R) as [V' U'].
    destruct (told_least t _ (proj2 (M t T R)) V' U') as [f [F _]]. now exists f.
Qed.

Lemma infinite_untold : forall s, valid spec s -> ~ safe spec s -> told s = None -> ~ exists e, back_after pi s (pi s) e.
Proof.
  intros s V U E [e H]. apply back_within_after in H. destruct (told_least s e H V U) as [w [F _]]. congruence.
Qed.

(** With another set in [s], the states that come back by the policy still do, if [s] does. *)
Lemma changed_back : forall s A c, valid spec s -> ~ safe spec s -> ok spec order s A ->
  (forall w, told s = Some w -> back_within (change pi s A) s c \/ c = no_effort /\ takes less s A w = true) ->
  forall w t, valid spec t -> ~ safe spec t -> told t = Some w -> back_within (change pi s A) t (plus w c).
Proof.
  intros s A c V U allowed now w. induction w as [w IH] using effort_ind. intros t V' U' E.
  assert (go : forall B, change pi s A t = B -> ok spec order t B -> takes not_more t B w = true ->
    back_within (change pi s A) t (plus w c)).
  { intros B same okB H. destruct (proj1 (takes_spec _ _ _ _) H) as [N M]. rewrite not_more_spec in N.
    apply back with (fun u => plus (said u) c); rewrite same; [unfold plus; efforts | |].
    all: intros u T R; destruct (M u T R) as [f [F L]]; rewrite not_more_spec in L; unfold said; rewrite F.
    - unfold plus. efforts.
    - destruct (unsafe_after t _ u V' U' okB T R) as [V'' U'']. apply IH; auto. efforts. }
  destruct (list_eq_dec Nat.eq_dec t s) as [->|differ].
  - destruct (now w E) as [B|[-> H]].
    + apply (back_within_more _ _ _ c); [exact B | unfold plus; efforts].
    + apply (go A); [apply change_here | exact allowed |]. apply takes_spec in H. apply takes_spec.
      destruct H as [N M]. rewrite less_spec in N. split; [apply not_more_spec; efforts|].
      intros t T R. destruct (M t T R) as [f [F L]]. exists f. split; [exact F|].
      rewrite less_spec in L. apply not_more_spec. efforts.
  - apply (go (pi t)); [now apply change_there | now apply keep | now apply told_takes].
Qed.

End Exact.

(** What is told by the least efforts passes. *)
Lemma least_told :
  (forall s, valid spec s -> ~ safe spec s -> match told s with
    | Some w => (1 <= snd w)%N /\ back_within pi s w /\ forall e, back_within pi s e -> at_most w e
    | None => forall e, ~ back_within pi s e
    end) -> all_told.
Proof.
  intros least s V U. unfold is_told.
  assert (build : forall e, at_most (longer (pi s) no_effort) e ->
    (forall t, to s (pi s) t -> ~ restored s t -> exists f, told t = Some f /\ at_most (longer (pi s) f) e) ->
    back_within pi s e).
  { intros e N M. apply back with said; [exact N | |].
    all: intros t T R; destruct (M t T R) as [f [F L]]; unfold said; rewrite F.
    - exact L.
    - destruct (unsafe_after s _ t V U (keep s V) T R) as [V' U']. specialize (least t V' U'). rewrite F in least.
      apply least. }
  assert (H := least s V U). destruct (told s) as [w|].
  - destruct H as [some [B L]]. eager. rewrite andb_true_iff. split.
    + destruct B as [s w rest N M B]. apply takes_spec. split; [now apply not_more_spec|]. intros t T R.
      destruct (unsafe_after s _ t V U (keep s V) T R) as [V' U']. specialize (least t V' U').
      specialize (M t T R). specialize (B t T R). destruct (told t) as [f|]; [|now apply least in B].
      exists f. split; [reflexivity|]. apply not_more_spec. apply least in B. efforts.
    + apply negb_true_iff, not_true_iff_false. rewrite takes_spec. intros [N M]. rewrite less_spec in N.
      assert (K : at_most w (before w)); [|now apply before_spec in K; [apply K; efforts | exact some]].
      apply L, build; [now apply before_spec|]. intros t T R. destruct (M t T R) as [f [F G]]. exists f.
      split; [exact F|]. apply less_spec in G. now apply before_spec.
  - apply negb_true_iff, not_true_iff_false. rewrite ends_spec. intros M.
    destruct (bounded (pi s) told states) as [e [N K]]. apply (H e), build; [exact N|].
    intros t T R. destruct (M t T R) as [f F]. exists f. split; [exact F|]. apply (K t); [|exact F].
    destruct (unsafe_after s _ t V U (keep s V) T R) as [V' _]. apply in_all_states, V'.
Qed.

End Told.

End Restoring.
