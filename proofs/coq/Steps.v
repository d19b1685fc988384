(** The checker's answers about one step: safe states, outcomes, allowed sets. *)

From Coq Require Import Bool List Arith Lia Permutation.
From Tumato Require Import Semantics Checker Lists.
Import ListNotations.

Section Steps.

Variables (spec : specification) (order : ordering).

Lemma all_hold_spec : forall s fs, forallb (holds s []) fs = true <-> all_hold s fs.
Proof. intros s fs. apply forallb_forall. Qed.

Lemma assumed_spec : forall s, is_state spec s -> assumed spec s = true <-> valid spec s.
Proof. intros s H. unfold assumed, valid. eager. rewrite andb_true_iff, all_hold_spec. tauto. Qed.

Definition valid_at : state -> bool := is_true_at (build (assumed spec) (sizes spec)).

Definition safe_at : state -> bool := is_true_at (build (keeps_rules spec) (sizes spec)).

Lemma valid_at_spec : forall s, valid_at s = true <-> valid spec s.
Proof.
  intros s. unfold valid_at. rewrite is_true_at_spec. unfold assumed. eager. now rewrite andb_true_iff, all_hold_spec.
Qed.

Lemma all_hold_concat : forall s tiers, forallb (forallb (holds s [])) tiers = true <-> all_hold s (concat tiers).
Proof.
  intros s tiers. rewrite <- all_hold_spec. induction tiers as [|tier tiers IH]; [reflexivity|].
  cbn. now rewrite forallb_app, !andb_true_iff, IH.
Qed.

Lemma safe_at_spec : forall s, safe_at s = true <-> safe spec s.
Proof.
  intros s. unfold safe_at, safe, valid. rewrite is_true_at_spec. unfold keeps_rules, assumed.
  eager. rewrite !andb_true_iff, all_hold_spec, all_hold_concat. unfold is_state. tauto.
Qed.

(** ** Levels *)

Local Notation level := (level spec).
Local Notation highest := (length (state_rules spec)).

Lemma level_at_least : forall s n, n <= highest -> n <= level s <-> all_hold s (concat (firstn n (state_rules spec))).
Proof.
  intros s. unfold Semantics.level. induction (state_rules spec) as [|tier tiers IH]; intros n; cbn [length].
  - intros H. replace n with 0 by lia. cbn. split; [now intros _ f | lia].
  - destruct n as [|n]; intros H; [cbn; split; [now intros _ f | lia]|].
    cbn [firstn concat tiers_satisfied]. rewrite <- all_hold_spec, forallb_app, andb_true_iff, !all_hold_spec.
    rewrite <- (all_hold_spec s tier). destruct (forallb (holds s []) tier).
    + rewrite <- IH by lia. intuition lia.
    + split; [intros L; exfalso; lia | intros [F _]; discriminate].
Qed.

Lemma level_at_most : forall s, level s <= highest.
Proof.
  intros s. unfold Semantics.level. induction (state_rules spec) as [|tier tiers IH]; [reflexivity|].
  cbn. destruct (forallb _ tier); lia.
Qed.

Lemma level_safe : forall s, safe spec s <-> valid spec s /\ level s = highest.
Proof.
  intros s. unfold safe. rewrite <- (firstn_all (state_rules spec)) at 1. rewrite <- level_at_least by reflexivity.
  assert (H := level_at_most s). intuition lia.
Qed.

Lemma restored_unsafe : forall s t, valid spec s -> valid spec t -> ~ safe spec s -> ~ restored spec s t -> ~ safe spec t.
Proof.
  intros s t V W U N. unfold restored in N. rewrite level_safe in *. assert (H := level_at_most s). intuition lia.
Qed.

(** A step keeps the level, and under [OneStep] raises it. *)
Lemma kept_level : forall s t, kept spec s t -> level s <= level t.
Proof.
  intros s t [_ K]. apply level_at_least; [apply level_at_most|]. intros f H.
  assert (here : all_hold s (concat (firstn (level s) (state_rules spec)))) by (apply level_at_least; [apply level_at_most | reflexivity]).
  apply K. unfold required.
  assert (C : In f (concat (firstn (S (level s)) (state_rules spec)))).
  { apply in_concat in H. destruct H as [tier [H F]]. apply in_concat. exists tier. split; [|exact F].
    revert H. clear. generalize (level s). induction (state_rules spec) as [|x l IH]; intros [|n]; cbn; try tauto.
    intros [->|H]; [now left | right; now apply IH]. }
  destruct (restored_in spec); [exact C | | ]; apply filter_In; split; try exact C; now apply here.
Qed.

Lemma kept_safe : forall s t, safe spec s -> kept spec s t -> safe spec t.
Proof.
  intros s t H K. assert (L := kept_level s t K). apply level_safe in H. apply level_safe. destruct H as [_ H].
  assert (M := level_at_most t). split; [apply K | lia].
Qed.

Lemma kept_restored : forall s t, restored_in spec = OneStep -> valid spec s -> ~ safe spec s -> kept spec s t ->
  restored spec s t.
Proof.
  intros s t O V U [W K]. split; [exact W|]. rewrite level_safe in U. assert (M := level_at_most s).
  assert (L : level s <> highest) by tauto. apply level_at_least; [lia|]. unfold required in K. rewrite O in K. exact K.
Qed.

Lemma safe_kept : forall s t, safe spec s -> kept spec s t <-> safe spec t.
Proof.
  intros s t H. split; [now apply kept_safe|]. intros [V R]. split; [exact V|].
  apply level_safe in H. destruct H as [_ H]. unfold required.
  assert (E : firstn (S (level s)) (state_rules spec) = state_rules spec) by (apply firstn_all2; lia). rewrite E.
  destruct (restored_in spec); [exact R| | ]; intros f F; apply filter_In in F; now apply R.
Qed.

Lemma alone_kept : forall s t, alone spec = true -> valid spec s -> kept spec s t <-> safe spec t.
Proof.
  intros s t O V. unfold alone in O. unfold kept, required, safe.
  destruct (restored_in spec); try discriminate. destruct (state_rules spec) as [|tier [|]]; try discriminate; [reflexivity|].
  cbn [firstn concat]. replace (firstn (level s) []) with (@nil (list formula)) by now rewrite firstn_nil. reflexivity.
Qed.

Definition kept_at : state -> state -> bool := is_kept spec valid_at safe_at.

Lemma kept_at_spec : forall s t, valid spec s -> kept_at s t = true <-> kept spec s t.
Proof.
  intros s t V. unfold kept_at, is_kept. destruct (alone spec) eqn:O.
  { rewrite alone_kept by assumption. apply safe_at_spec. }
  destruct (safe_at s) eqn:F.
  { apply safe_at_spec in F. rewrite safe_kept by exact F. apply safe_at_spec. }
  cbv zeta beta. eager. rewrite andb_true_iff, valid_at_spec, all_hold_spec. reflexivity.
Qed.

(** ** What a step can lead to *)

Section Good.

Variable good : state -> actions -> bool.

Lemma one_good_spec : forall s A, one_good spec good s A = true <->
  forall a e, In a A -> In e (effects spec a) -> good (apply e s) (without a A) = true.
Proof.
  intros s A. unfold one_good. cbv zeta. rewrite forallb_forall. split.
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

Lemma struck_some : forall A s t B, struck spec A s t B -> exists a e, In a A /\ In e (effects spec a).
Proof. intros A s t B H. destruct H as [A s a e | A s a e]; now exists a, e. Qed.

Lemma at_rest_spec : forall A, at_rest spec A = true <-> forall a, In a A -> effects spec a = [].
Proof.
  intros A. unfold at_rest. rewrite forallb_forall. split; intros H a Ha; specialize (H a Ha).
  - destruct (effects spec a); [reflexivity | discriminate].
  - now rewrite H.
Qed.

Context (less : forall t B C, incl B C -> good t C = true -> good t B = true).

Lemma struck_good_all : forall A s t D, struck spec A s t D ->
  forall n f B, struck_good spec good n f = true -> In (s, B) f -> incl A B -> length B <= n -> good t D = true.
Proof.
  induction 1 as [A s a e Ha He | A s a e t D Ha He further IH]; intros n f B F Hf more long.
  all: assert (HB := more a Ha).
  all: assert (fewer : incl (without a A) (without a B))
    by (intros b Hb; apply in_without in Hb; apply in_without; split; [now apply more | apply Hb]).
  all: destruct n as [|n]; [destruct B; cbn in *; [contradiction | lia]|].
  all: pose proof F as G; cbn [struck_good] in G; revert G; eager; rewrite andb_true_iff; intros [now later].
  - rewrite forallb_forall in now. specialize (now _ Hf). cbn [fst snd] in now. rewrite one_good_spec in now.
    apply (less _ _ (without a B)); [exact fewer | now apply now].
  - destruct (list_eq_dec Nat.eq_dec (apply e s) s) as [same|new].
    + apply (IH (S n) f B F); [now rewrite same | | exact long].
      intros b Hb. apply in_without in Hb. now apply more.
    + assert (shorter := without_shorter _ _ HB).
      destruct (struck_some _ _ _ _ further) as (b & _ & some & _). apply fewer in some.
      destruct n as [|n]; [destruct (without a B); cbn in *; [contradiction | lia]|].
      apply (IH (S n) (distinct (after_one spec f)) (without a B) later); [|exact fewer | lia].
      now apply in_distinct, in_after_one.
Qed.

Lemma all_struck_good : forall n f,
  (forall s A t B, In (s, A) f -> struck spec A s t B -> good t B = true) -> struck_good spec good n f = true.
Proof.
  induction n as [|n IH]; intros f H; [reflexivity|].
  cbn [struck_good]. eager. apply andb_true_iff. split.
  - apply forallb_forall. intros [s A] Hf. apply one_good_spec. intros a e Ha He.
    apply (H s A); [exact Hf | now apply last_effect].
  - destruct n as [|n]; [reflexivity|]. apply IH. intros t B u D HB Hu.
    apply in_distinct, after_one_in in HB. destruct HB as (s & A & a & e & Hf & Ha & He & [= -> ->]).
    apply (H s A); [exact Hf | now apply next_effect with a e].
Qed.

Lemma after_good_spec : forall s A,
  after_good spec order good s A = true <-> forall t B, after spec order s A t B -> good t B = true.
Proof.
  intros s A. unfold after_good, after. destruct order.
  - split.
    + intros F t B H. apply (struck_good_all _ _ _ _ H _ _ A F); [now left | now intros b | lia].
    + intros H. apply all_struck_good. intros s' A' t B [[= <- <-]|[]] Ht. now apply H.
  - cbn [struck_good forallb fst snd]. eager. rewrite !andb_true_r, one_good_spec. split.
    + intros F t B (a & e & Ha & He & -> & ->). now apply F.
    + intros H a e Ha He. apply H. now exists a, e.
Qed.

End Good.

Lemma after_some : forall s A t B, after spec order s A t B -> exists a e, In a A /\ In e (effects spec a).
Proof.
  intros s A t B H. unfold after in H. destruct order; [now apply struck_some in H|].
  destruct H as (a & e & Ha & He & _). now exists a, e.
Qed.

Section Fine.

Variable fine : state -> bool.

Lemma out_fine_spec : forall s A,
  out_fine spec order fine s A = true <-> forall t, out spec order s A t -> fine t = true.
Proof.
  intros s A. unfold out_fine, out. destruct (at_rest spec A) eqn:R.
  { rewrite at_rest_spec in R. split.
    - intros F t [[-> _]|[B H]]; [exact F|]. apply after_some in H. destruct H as (a & e & Ha & He).
      rewrite (R a Ha) in He. contradiction.
    - intros H. apply H. now left. }
  assert (acts : ~ forall a, In a A -> effects spec a = []) by (rewrite <- at_rest_spec, R; discriminate).
  rewrite after_good_spec by auto. split.
  - intros F t [[_ N]|[B H]]; [contradiction | now apply (F t B)].
  - intros H t B T. apply H. right. now exists B.
Qed.

Lemma next_fine_spec : forall s A,
  next_fine spec order fine s A = true <-> forall t, next spec order s A t -> fine t = true.
Proof.
  intros s A. unfold next_fine. eager. rewrite andb_true_iff, out_fine_spec. unfold next. split.
  - intros [D O] t [H | ->]; auto.
  - intros H. auto.
Qed.

Lemma nominally_fine_spec : forall s A,
  nominally_fine spec fine s A = true <-> forall t, nominally spec s A t -> fine t = true.
Proof. intros s A. unfold nominally_fine, nominally. split; [now intros H t -> | auto]. Qed.

End Fine.

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

Lemma lasting_spec : forall s A, after_good spec order (fun t => forallb (lasting spec t)) s A = true <->
  forall t B a, after spec order s A t B -> In a B -> all_hold t (preconditions (the spec a)).
Proof.
  intros s A. rewrite after_good_spec.
  - split.
    + intros H t B a T Ha. specialize (H t B T). rewrite forallb_forall in H. now apply all_hold_spec, H.
    + intros H t B T. apply forallb_forall. intros a Ha. now apply all_hold_spec, (H t B).
  - intros t B C fewer. rewrite !forallb_forall. auto.
Qed.

Lemma is_ok_spec : forall s A, valid spec s -> is_ok spec order (kept_at s) s A = true <-> ok spec order s A.
Proof.
  intros s A V. unfold is_ok. eager.
  rewrite !andb_true_iff, orb_true_iff, negb_true_iff, pairs_spec, next_fine_spec, lasting_spec, !forallb_forall.
  assert (K : (forall t, next spec order s A t -> kept_at s t = true) <-> (forall t, next spec order s A t -> kept spec s t)).
  { split; intros H t N; now apply kept_at_spec, H. }
  rewrite K. assert (same : (forall a, In a A -> applicable spec s a = true) <->
    (forall a, In a A -> all_hold s (conditions spec a))).
  { split; intros H a Ha; now apply all_hold_spec, H. }
  rewrite same. split.
  - intros [[[[P [R N]] Q] O] L]. constructor; auto. intros T. destruct L as [L|L]; [congruence | exact L].
  - intros [P R N Q O L]. destruct (throughout spec); intuition.
Qed.

Lemma ok_next : forall s A t, ok spec order s A -> next spec order s A t -> valid spec t.
Proof. intros s A t H N. apply (steps_kept _ _ _ _ H t N). Qed.

Lemma ok_delta : forall s A, ok spec order s A -> kept spec s (delta spec s A).
Proof. intros s A H. apply (steps_kept _ _ _ _ H). now right. Qed.

End Steps.
