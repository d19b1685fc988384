(** A checker that a computer can run: it goes through all states of a policy table, explicitly.

    [Correct.v] proves that its answer [true] means what [Semantics.v] says. What is needed again and again, the safe
    states and the policy, is kept in trees with one level for every variable. *)

From Coq Require Import Bool List Arith NArith Lia Orders Mergesort.
From Tumato Require Import Semantics.
Import ListNotations.

(** Computes [b] only where [a] is true, or only where it is false. *)
Notation "a &&& b" := (if a then b else false) (at level 40, left associativity).
Notation "a ||| b" := (if a then true else b) (at level 50, left associativity).

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

(** What the tree says of a state, [false] or [None] where it does not know the state. *)
Definition is_true_at (t : tree bool) (s : state) : bool := match lookup t s with Some b => b | None => false end.

Definition entry {X} (t : tree (option X)) (s : state) : option X := match lookup t s with Some e => e | None => None end.

(** A policy table; [None] where nothing is decided. *)
Definition table := tree (option actions).

Definition policy_of (t : table) : policy :=
  fun s => match lookup t s with Some (Some A) => A | _ => [] end.

(** For the unsafe states, the least efforts of a policy with [back_within next] and with [back_within nominally];
    [None] where there is none. They come from outside, and are checked. *)
Record efforts := { worst : tree (option effort); nominal_sum : tree (option effort) }.

(** Where restoring takes one step, there is nothing to be said. *)
Definition no_efforts : efforts := {| worst := Node []; nominal_sum := Node [] |}.

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

(** Efforts. *)
Definition less (e f : effort) : bool := (fst e <? fst f)%N || (fst e =? fst f)%N && (snd e <? snd f)%N.

Definition not_more (e f : effort) : bool := (fst e <? fst f)%N || (fst e =? fst f)%N && (snd e <=? snd f)%N.

(** As [forallb], but computes no further than to the first [false]. *)
Fixpoint every {X} (f : X -> bool) (l : list X) : bool :=
  match l with [] => true | x :: l => f x &&& every f l end.

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

Definition assumed (s : state) : bool := forallb (holds s []) (assumptions spec) &&& part spec s.

Definition keeps_rules (s : state) : bool := assumed s && forallb (forallb (holds s [])) (state_rules spec).

(** Whether two different actions have no resource in common and agree in their nominal effects. *)
Definition compatible (a b : nat) : bool :=
  disjoint (resources (the spec a)) (resources (the spec b)) && agree (nominal (the spec a)) (nominal (the spec b)).

Definition applicable (s : state) (a : nat) : bool := forallb (holds s []) (conditions spec a).

(** Whether an action that was started before may still take effect, where preconditions have to hold throughout. *)
Definition lasting (s : state) (a : nat) : bool := forallb (holds s []) (preconditions (the spec a)).

(** ** What a step can lead to *)

(** Whether [good] holds wherever one effect leads from [s], of the state and the actions that have not struck. *)
Definition one_good (good : state -> actions -> bool) (s : state) (A : actions) : bool :=
  forallb (fun a => let B := without a A in forallb (fun e => good (apply e s) B) (effects spec a)) A.

(** Where one more effect leads. An effect that changes nothing leads nowhere new, and leaves less to strike. *)
Definition after_one (f : front) : front :=
  flat_map (fun p => flat_map (fun a =>
    map (fun e => (apply e (fst p), without a (snd p)))
      (filter (fun e => negb (same_list (apply e (fst p)) (fst p))) (effects spec a))) (snd p)) f.

(** Whether [good] holds wherever up to [n] effects lead. What is good has to be so with less to strike, too. *)
Fixpoint struck_good (good : state -> actions -> bool) (n : nat) (f : front) : bool :=
  match n with
  | 0 => true
  | S n =>
      forallb (fun p => one_good good (fst p) (snd p)) f &&&
      match n with 0 => true | _ => struck_good good n (distinct (after_one f)) end
  end.

Definition after_good (good : state -> actions -> bool) (s : state) (A : actions) : bool :=
  struck_good good (match order with Any => length A | First => 1 end) [(s, A)].

(** Whether no action of [A] takes effect. *)
Definition at_rest (A : actions) : bool :=
  forallb (fun a => match effects spec a with [] => true | _ :: _ => false end) A.

Definition out_fine (fine : state -> bool) (s : state) (A : actions) : bool :=
  if at_rest A then fine s else after_good (fun t _ => fine t) s A.

(** Whether [fine] holds wherever a step leads: to any state, or to the nominal successor. *)
Definition next_fine (fine : state -> bool) (s : state) (A : actions) : bool :=
  fine (delta spec s A) &&& out_fine fine s A.

Definition nominally_fine (fine : state -> bool) (s : state) (A : actions) : bool := fine (delta spec s A).

(** [ok], where [fine] tells the states that [kept] allows. *)
Definition is_ok (fine : state -> bool) (s : state) (A : actions) : bool :=
  forallb (applicable s) A &&&
  forallb (fun a => forallb (fun b =>
    if a =? b then agree (nominal (the spec a)) (nominal (the spec a)) else compatible a b) A) A &&&
  forallb (holds s A) (reaction_rules spec) &&&
  next_fine fine s A &&&
  (negb (throughout spec) ||| after_good (fun t => forallb (lasting t)) s A).

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

(** ** Sets that may be better *)

(** Whether [good] holds for every set that adds to [chosen] (the latest first) some of [candidates], of total duration
    less than [budget], any two of them compatible. *)
Fixpoint all_cheaper (good : actions -> bool) (candidates chosen : actions) (budget : N) : bool :=
  match candidates with
  | [] => good (rev chosen)
  | a :: rest =>
      all_cheaper good rest chosen budget &&&
      (if (duration (the spec a) <? budget)%N && forallb (compatible a) chosen
       then all_cheaper good rest (a :: chosen) (budget - duration (the spec a))%N
       else true)
  end.

(** Actions that an allowed set can contain: applicable, and fine when they are the only ones to strike. *)
Definition candidates (fine : state -> bool) (s : state) : actions :=
  filter (fun a => applicable s a &&& one_good (fun t _ => fine t) s [a])
    (seq 0 (length (declared spec))).

(** ** The judgement of one policy *)

Section Judging.

Variables (is_valid is_safe : state -> bool) (states : list state) (fuel : nat) (pi : policy)
  (known : efforts).

(** Whether unsafe states are left for good by any step: then the decisions there serve nobody else's run. *)
Definition alone : bool :=
  match restored_in spec, state_rules spec with
  | OneStep, [] | OneStep, [_] => true
  | _, _ => false
  end.

(** The states that [kept] allows after [s]. *)
Definition is_kept (s : state) : state -> bool :=
  if alone then is_safe
  else if is_safe s then is_safe
  else let rules := required spec s in fun t => is_valid t &&& forallb (holds t []) rules.

(** Whether the run from [s] that starts with [A] and goes on with [pi] meets its goal within the bound. *)
Definition serves (pi : policy) (s : state) (A : actions) : bool :=
  let bodies := active spec s in
  let first := delta spec s A in
  chase (fun t => forallb (holds t A) bodies &&& is_safe t) (fun t => delta spec t (pi t))
    fuel 1%N first 1%N 1%N first.

(** Restored after [s], or back within [limit] all the same, by the efforts that are known; [within] compares. *)
Definition is_back (told : state -> option effort) (s : state) (good : effort -> bool) : state -> bool :=
  let now := level spec s in
  fun t => (is_valid t &&& (now <? level spec t)) ||| match told t with Some e => good e | None => false end.

Definition is_restored (s : state) : state -> bool := is_back (fun _ => None) s (fun _ => true).

Definition fine_along := (state -> bool) -> state -> actions -> bool.

(** Whether the effort with [A] in [s] is, by [told], less than [limit], or not more. *)
Definition takes (compare : effort -> effort -> bool) (told : state -> option effort) (along : fine_along)
    (s : state) (A : actions) (limit : effort) : bool :=
  compare (longer spec A no_effort) limit &&& along (is_back told s (fun e => compare (longer spec A e) limit)) s A.

Definition ends (told : state -> option effort) (along : fine_along) (s : state) (A : actions) : bool :=
  along (is_back told s (fun _ => true)) s A.

(** Whether [told] says of [s] what follows from what it says of the states after. *)
Definition is_told (told : state -> option effort) (along : fine_along) (s : state) (A : actions) : bool :=
  match told s with
  | Some e => takes not_more told along s A e &&& negb (takes less told along s A e)
  | None => negb (ends told along s A)
  end.

Definition decided (e : option effort) : bool := match e with Some _ => true | None => false end.

Definition is_restoring (s : state) (A : actions) : bool :=
  match restored_in spec with
  | OneStep => true
  | Bounded => decided (entry (worst known) s) &&& is_told (entry (worst known)) next_fine s A
  | Fair =>
      decided (entry (nominal_sum known) s) &&& is_told (entry (nominal_sum known)) nominally_fine s A &&&
      is_told (entry (worst known)) next_fine s A
  end.

(** Whether an allowed set restores [s] in one step. *)
Definition is_at_once (s : state) (A : actions) : bool :=
  match restored_in spec with OneStep => true | _ => next_fine (is_restored s) s A end.

(** [better], for allowed sets: [B] in the place of [A]. *)
Definition is_better (s : state) (A B : actions) : bool :=
  if is_at_once s B then
    if is_at_once s A then (total_duration spec B <? total_duration spec A)%N else true
  else if is_at_once s A then false
  else match entry (worst known) s, entry (nominal_sum known) s with
  | Some e, _ => takes less (entry (worst known)) next_fine s B e
  | None, Some e =>
      if ends (entry (worst known)) next_fine s B then true
      else takes less (entry (nominal_sum known)) nominally_fine s B e
  | None, None => false
  end.

(** The policy with [B] in [s], quickly. *)
Definition swap (s : state) (B : actions) : policy := fun t => if same_list t s then B else pi t.

(** Whether all runs meet their goals when [s] takes [B]. *)
Definition all_served (s : state) (B : actions) : bool :=
  let pi := swap s B in
  serves pi s B &&& (alone ||| every (fun t => if is_valid t then serves pi t (pi t) else true) states).

Definition no_better (s : state) (A : actions) : bool :=
  let fine := is_kept s in
  let some := candidates fine s in
  let budget := if is_at_once s A then total_duration spec A else (1 + total_duration spec some)%N in
  let useless B := if is_ok fine s B then if is_better s A B then negb (all_served s B) else true else true in
  (budget =? 0)%N ||| all_cheaper useless some [] budget.

Definition check_state (s : state) (A : actions) : bool :=
  is_action_set A &&&
  is_ok (is_kept s) s A &&&
  serves pi s A &&&
  (is_safe s ||| (is_restoring s A &&& no_better s A)).

End Judging.

(** ** The whole *)

Definition check (t : table) (known : efforts) : bool :=
  let valid_states := build assumed (sizes spec) in
  let safe_states := build keeps_rules (sizes spec) in
  let states := all_states (sizes spec) in
  let fuel := length states in
  let judge := check_state (is_true_at valid_states) (is_true_at safe_states) states fuel (policy_of t) known in
  forallb (fun s => negb (assumed s) ||| match entry t s with Some A => judge s A | None => false end) states.

End Checking.

(** ** From starts *)

Definition decides (t : table) : state -> bool := fun s => match entry t s with Some _ => true | None => false end.

Definition is_start (spec : specification) (s : state) : bool :=
  match starts spec with [] => true | _ :: _ => existsb (holds s []) (starts spec) end.

Definition check_from_starts (spec : specification) (order : ordering) (t : table) (known : efforts) : bool :=
  every (fun s => if assumed spec s then negb (is_start spec s) ||| decides t s else negb (decides t s))
    (all_states (sizes spec)) &&&
  check (within spec (decides t)) order t known.
