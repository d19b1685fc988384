(** A checker that a computer can run: it goes through all states of a policy table, explicitly.

    [Correct.v] proves that its answer [true] means what [Semantics.v] says. What is needed again and again, the safe
    states and the policy, is kept in trees with one level for every variable. *)

From Coq Require Import Bool List Arith NArith Lia Orders Mergesort.
From Tumato Require Import Semantics.
Import ListNotations.

(** ** Trees over states *)

Inductive tree (X : Type) :=
| Leaf (x : X)
| Node (children : list (tree X)).
Arguments Leaf {X} x.
Arguments Node {X} children.

Fixpoint lookup {X} (t : tree X) (s : state) : option X :=
  match s, t with
  | [], Leaf x => Some x
  | v :: s, Node children => match nth_error children v with Some child => lookup child s | None => None end
  | _, _ => None
  end.

(** The tree of [f] over all states. *)
Fixpoint build {X} (f : state -> X) (sizes : list nat) : tree X :=
  match sizes with
  | [] => Leaf (f [])
  | size :: sizes => Node (map (fun v => build (fun s => f (v :: s)) sizes) (seq 0 size))
  end.

Fixpoint all_states (sizes : list nat) : list state :=
  match sizes with
  | [] => [[]]
  | size :: sizes => let below := all_states sizes in flat_map (fun v => map (cons v) below) (seq 0 size)
  end.

(** A policy table; [None] where nothing is decided. *)
Definition table := tree (option actions).

Definition policy_of (t : table) : policy :=
  fun s => match lookup t s with Some (Some A) => A | _ => [] end.

(** ** Small questions *)

Fixpoint same_list (s t : list nat) : bool :=
  match s, t with
  | [], [] => true
  | v :: s, w :: t => (v =? w) && same_list s t
  | _, _ => false
  end.

Definition disjoint (A B : list nat) : bool := forallb (fun a => negb (member a B)) A.

Definition agree (e f : assignment) : bool :=
  forallb (fun p => forallb (fun q => negb (fst p =? fst q) || (snd p =? snd q)) f) e.

(** Lexicographic order. *)
Fixpoint not_after (s t : list nat) : bool :=
  match s, t with
  | [], _ => true
  | _, [] => false
  | v :: s, w :: t => (v <? w) || (v =? w) && not_after s t
  end.

Fixpoint increasing_below (most : nat) (least : nat) (A : actions) : bool :=
  match A with
  | [] => true
  | a :: A => (least <=? a) && (a <? most) && increasing_below most (S a) A
  end.

(** ** States on the way, each with the actions that have not struck yet *)

Definition front := list (state * actions).

Module PairOrder <: TotalLeBool.
  Definition t : Type := state * actions.
  Definition leb (p q : t) : bool := not_after (fst p ++ snd p) (fst q ++ snd q).
  Lemma leb_total : forall p q, leb p q = true \/ leb q p = true.
  Proof.
    intros p q. unfold leb. generalize (fst p ++ snd p) (fst q ++ snd q).
    induction l as [|v l IH]; intros [|w m]; auto. cbn [not_after].
    destruct (Nat.ltb_spec v w), (Nat.ltb_spec w v), (Nat.eqb_spec v w), (Nat.eqb_spec w v);
      auto; try lia; apply IH.
  Qed.
End PairOrder.

Module PairSort := Sort PairOrder.

Fixpoint without_repeats (f : front) : front :=
  match f with
  | [] => []
  | p :: f =>
      match f with
      | q :: _ => if same_list (fst p) (fst q) && same_list (snd p) (snd q) then without_repeats f
                  else p :: without_repeats f
      | [] => [p]
      end
  end.

Definition distinct (f : front) : front := without_repeats (PairSort.sort f).

Section Checking.

Variables (spec : specification) (order : ordering).

Definition is_action_set (A : actions) : bool := increasing_below (length (declared spec)) 0 A.

Definition assumed (s : state) : bool := forallb (holds s []) (assumptions spec).

Definition keeps_rules (s : state) : bool := assumed s && forallb (holds s []) (state_rules spec).

(** Whether two different actions have no resource in common and agree in their nominal effects. *)
Definition compatible (a b : nat) : bool :=
  disjoint (resources (the spec a)) (resources (the spec b)) && agree (nominal (the spec a)) (nominal (the spec b)).

Definition applicable (s : state) (a : nat) : bool := forallb (holds s []) (preconditions (the spec a)).

(** ** What a step can lead to *)

Definition one_fine (fine : state -> bool) (s : state) (A : actions) : bool :=
  forallb (fun a => forallb (fun e => fine (apply e s)) (effects spec a)) A.

(** Where one more effect leads. An effect that changes nothing leads nowhere new, and leaves less to strike. *)
Definition after_one (f : front) : front :=
  flat_map (fun p => flat_map (fun a =>
    map (fun e => (apply e (fst p), without a (snd p)))
      (filter (fun e => negb (same_list (apply e (fst p)) (fst p))) (effects spec a))) (snd p)) f.

(** Whether [fine] holds in all states that up to [n] effects lead to. *)
Fixpoint struck_fine (fine : state -> bool) (n : nat) (f : front) : bool :=
  match n with
  | 0 => true
  | S n =>
      forallb (fun p => one_fine fine (fst p) (snd p)) f &&
      match n with 0 => true | _ => struck_fine fine n (distinct (after_one f)) end
  end.

(** Whether no action of [A] takes effect. *)
Definition at_rest (A : actions) : bool :=
  forallb (fun a => match effects spec a with [] => true | _ :: _ => false end) A.

Definition out_fine (fine : state -> bool) (s : state) (A : actions) : bool :=
  if at_rest A then fine s
  else struck_fine fine (match order with Any => length A | First => 1 end) [(s, A)].

(** [ok], where [fine] tells the safe states. *)
Definition is_ok (fine : state -> bool) (s : state) (A : actions) : bool :=
  forallb (applicable s) A &&
  forallb (fun a => forallb (fun b =>
    if a =? b then agree (nominal (the spec a)) (nominal (the spec a)) else compatible a b) A) A &&
  forallb (holds s A) (reaction_rules spec) &&
  fine (delta spec s A) &&
  out_fine fine s A.

(** ** Runs *)

Definition is_within (k : N) : bool := match max_plan_length spec with None => true | Some most => (k <=? most)%N end.

(** Follow a run that has come to [here] after [k] steps: is [hit] within the bound? To notice loops early, a state of
    the past is remembered: the one met [lag] steps ago, replaced by the present one whenever [lag] comes to [patience],
    which then doubles. [fuel] is the number of states: nothing new comes later. *)
Fixpoint chase (hit : state -> bool) (next : state -> state) (fuel : nat) (k : N)
    (past : state) (lag patience : N) (here : state) : bool :=
  if negb (is_within k) then false
  else if hit here then true
  else match fuel with
  | 0 => false
  | S fuel =>
      let there := next here in
      if same_list past there then false
      else if (lag =? patience)%N then chase hit next fuel (N.succ k) there 1%N (2 * patience)%N there
      else chase hit next fuel (N.succ k) past (N.succ lag) patience there
  end.

(** Whether the run from [s] that starts with [A] and goes on with [pi] meets its goal within the bound. *)
Definition serves (pi : policy) (fuel : nat) (s : state) (A : actions) : bool :=
  let bodies := active spec s in
  let first := delta spec s A in
  chase (fun t => forallb (holds t A) bodies) (fun t => delta spec t (pi t)) fuel 1%N first 1%N 1%N first.

(** ** Cheaper sets *)

(** Whether [good] holds for every set that adds to [chosen] (the latest first) some of [candidates], of total duration
    less than [budget], any two of them compatible. *)
Fixpoint all_cheaper (good : actions -> bool) (candidates chosen : actions) (budget : N) : bool :=
  match candidates with
  | [] => good (rev chosen)
  | a :: rest =>
      all_cheaper good rest chosen budget &&
      (if (duration (the spec a) <? budget)%N && forallb (compatible a) chosen
       then all_cheaper good rest (a :: chosen) (budget - duration (the spec a))%N
       else true)
  end.

(** Actions that an allowed set can contain: applicable, and safe when they are the only ones to strike. *)
Definition candidates (fine : state -> bool) (s : state) : actions :=
  filter (fun a => applicable s a && one_fine fine s [a])
    (seq 0 (length (declared spec))).

Definition no_better (fine : state -> bool) (pi : policy) (fuel : nat) (s : state) (A : actions) : bool :=
  let budget := total_duration spec A in
  let useless B := negb (is_ok fine s B && serves pi fuel s B) in
  (budget =? 0)%N || all_cheaper useless (candidates fine s) [] budget.

(** ** The whole *)

Definition check_state (fine : state -> bool) (t : table) (fuel : nat) (s : state) : bool :=
  match lookup t s with
  | Some (Some A) =>
      is_action_set A &&
      is_ok fine s A &&
      serves (policy_of t) fuel s A &&
      (fine s || no_better fine (policy_of t) fuel s A)
  | _ => false
  end.

Definition is_true_at (t : tree bool) (s : state) : bool := match lookup t s with Some b => b | None => false end.

Definition check (t : table) : bool :=
  let safe_states := build keeps_rules (sizes spec) in
  let states := all_states (sizes spec) in
  let fuel := length states in
  forallb (fun s => negb (assumed s) || check_state (is_true_at safe_states) t fuel s) states.

End Checking.
