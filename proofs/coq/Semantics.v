(** What a specification means, and when a policy is right.

    To be read beside [docs/semantics.md]; the section numbers are the same, and sections 9 and 10 are told where they
    belong; section 12, on starts, comes last. Nothing is proved here.
    Variables, values, resources and actions are numbers: positions in the declaration. *)

From Coq Require Import List Arith NArith Sorted.
Import ListNotations.

(** ** The parts of a specification *)

(** A state holds one value number for every variable. *)
Definition state := list nat.

(** A set of actions is the increasing list of its numbers (see [action_set] below). *)
Definition actions := list nat.

(** What an effect writes: pairs of a variable and its new value. *)
Definition assignment := list (nat * nat).

Inductive formula :=
| Constant (b : bool)
| Is (variable value : nat)
| Executing (action : nat)
| Not (f : formula)
| And (fs : list formula)
| Or (fs : list formula)
| Iff (f g : formula).

Record action := {
  duration : N;
  resources : list nat;
  preconditions : list formula;
  guard : list formula;  (* where it is the one that is meant, of several that stand for an action with clauses *)
  nominal : assignment;
  alternatives : list assignment
}.

(** In how many steps safety may be restored. *)
Inductive restoration := OneStep | Bounded | Fair.

Inductive kind := Priority | Constraint.

Inductive goal :=
| Simple (body : formula)
| When (condition : formula) (g : goal)
| Goals (k : kind) (members : list goal).

Record specification := {
  sizes : list nat;  (* how many values each variable has *)
  declared : list action;
  reaction_rules : list formula;
  state_rules : list (list formula);  (* by severity: the tiers, the most severe first *)
  assumptions : list formula;
  goals : option goal;
  max_plan_length : option N;
  restored_in : restoration;
  throughout : bool;  (* whether preconditions have to hold until the action takes effect *)
  starts : list formula;  (* the start conditions; see the end of this file *)
  part : state -> bool  (* which states are looked at: all, or those of a part *)
}.

Inductive ordering := Any | First.
Definition policy := state -> actions.

(** ** 1. States *)

Definition member (a : nat) (A : actions) : bool := existsb (Nat.eqb a) A.

(** Whether a formula is true in state [s] while the actions [A] are executed. *)
Fixpoint holds (s : state) (A : actions) (f : formula) : bool :=
  match f with
  | Constant b => b
  | Is x v => nth x s 0 =? v
  | Executing a => member a A
  | Not g => negb (holds s A g)
  | And fs => forallb (holds s A) fs
  | Or fs => existsb (holds s A) fs
  | Iff g h => Bool.eqb (holds s A g) (holds s A h)
  end.

(** All of the formulas [fs] are true in [s] (and none of them speaks of actions). *)
Definition all_hold (s : state) (fs : list formula) : Prop := forall f, In f fs -> holds s [] f = true.

Section Meaning.

Variables (spec : specification) (order : ordering).

Definition is_state (s : state) : Prop := Forall2 lt s (sizes spec).

(** Where only a part of the states is looked at, the others count as if an assumption excluded them (section 12). *)
Definition valid (s : state) : Prop := is_state s /\ all_hold s (assumptions spec) /\ part spec s = true.

Definition safe (s : state) : Prop := valid s /\ all_hold s (concat (state_rules spec)).

(** The level of a state (section 10): how many tiers it satisfies whole, counted from the most severe one. *)
Fixpoint tiers_satisfied (s : state) (tiers : list (list formula)) : nat :=
  match tiers with
  | [] => 0
  | tier :: tiers => if forallb (holds s []) tier then S (tiers_satisfied s tiers) else 0
  end.

Definition level (s : state) : nat := tiers_satisfied s (state_rules spec).

(** [t] has a higher level than [s]. Where all rules are of one severity: [t] is safe and [s] is not. *)
Definition restored (s t : state) : Prop := valid t /\ level s < level t.

(** ** 2. Actions *)

Definition action_set (A : actions) : Prop :=
  StronglySorted lt A /\ forall a, In a A -> a < length (declared spec).

(** The record of action number [a]; the empty one stands for numbers that are not declared. *)
Definition the (a : nat) : action :=
  nth a (declared spec)
    {| duration := 0; resources := []; preconditions := []; guard := []; nominal := []; alternatives := [] |}.

(** Where an action may start. *)
Definition conditions (a : nat) : list formula := preconditions (the a) ++ guard (the a).

(** What an action may do. One whose effects all write nothing never takes effect. *)
Definition effects (a : nat) : list assignment :=
  let written := nominal (the a) :: alternatives (the a) in
  if forallb (fun e : assignment => match e with [] => true | _ :: _ => false end) written then [] else written.

Fixpoint write (x v : nat) (s : state) : state :=
  match s, x with
  | [], _ => []
  | _ :: s, 0 => v :: s
  | w :: s, S x => w :: write x v s
  end.

(** The state after an effect: every variable that is not assigned keeps its value. *)
Definition apply (e : assignment) (s : state) : state := fold_left (fun s p => write (fst p) (snd p) s) e s.

(** The duration of a set is the sum of its actions' durations. *)
Definition total_duration (A : actions) : N := fold_right (fun a d => (duration (the a) + d)%N) 0%N A.

(** ** 3. What may be executed together *)

Definition without (a : nat) (A : actions) : actions := filter (fun b => negb (b =? a)) A.

(** [struck A s t B]: some non-empty sequence of distinct actions of [A], each contributing any one of its effects, leads
    from [s] to [t], and the other actions of [A] are [B]. *)
Inductive struck : actions -> state -> state -> actions -> Prop :=
| last_effect A s a e : In a A -> In e (effects a) -> struck A s (apply e s) (without a A)
| next_effect A s a e t B : In a A -> In e (effects a) -> struck (without a A) (apply e s) t B -> struck A s t B.

(** [after s A t B]: effects of [A] can lead from [s] to [t], when the actions [B] have not taken effect. *)
Definition after (s : state) (A : actions) (t : state) (B : actions) : Prop :=
  match order with
  | Any => struck A s t B
  | First => exists a e, In a A /\ In e (effects a) /\ t = apply e s /\ B = without a A
  end.

(** [out s A t]: a step with [A] from [s] can lead to [t]. Where no action of [A] takes effect, that is [s] itself. *)
Definition out (s : state) (A : actions) (t : state) : Prop :=
  (t = s /\ forall a, In a A -> effects a = []) \/ exists B, after s A t B.

(** The nominal successor: all nominal effects at once. *)
Definition delta (s : state) (A : actions) : state := apply (flat_map (fun a => nominal (the a)) A) s.

(** [Next(s, A)]: every state in which the next decision may be taken (section 9). *)
Definition next (s : state) (A : actions) (t : state) : Prop := out s A t \/ t = delta s A.

(** The state rules that a step from [s] has to keep: those of the tiers up to the first that [s] breaks, this one
    included, and of these, where restoring may take several steps, the ones that hold in [s]. Where all rules are of
    one severity, and in a safe state: under [OneStep] all rules, and otherwise all that hold in [s]. *)
Definition required (s : state) : list formula :=
  let concerned := concat (firstn (S (level s)) (state_rules spec)) in
  match restored_in spec with
  | OneStep => concerned
  | _ => filter (holds s []) concerned
  end.

Definition kept (s t : state) : Prop := valid t /\ all_hold t (required s).

(** The set [A] is allowed in state [s]; under [Bounded] and [Fair] this is [Keep(s, A)] of section 9. *)
Record ok (s : state) (A : actions) : Prop := {
  preconditions_hold : forall a, In a A -> all_hold s (conditions a);
  resources_differ : forall a b r, In a A -> In b A -> a <> b ->
    In r (resources (the a)) -> ~ In r (resources (the b));
  nominals_agree : forall a b x v w, In a A -> In b A ->
    In (x, v) (nominal (the a)) -> In (x, w) (nominal (the b)) -> v = w;
  reaction_rules_hold : forall f, In f (reaction_rules spec) -> holds s A f = true;
  steps_kept : forall t, next s A t -> kept s t;
  preconditions_last : throughout spec = true ->
    forall t B a, after s A t B -> In a B -> all_hold t (preconditions (the a))
}.

(** ** 4. Goals *)

Definition found (entered : option (list formula)) : list formula :=
  match entered with None => [] | Some bodies => bodies end.

(** The bodies that a goal makes active in [s], or [None] where it is not entered. *)
Fixpoint walk (s : state) (g : goal) : option (list formula) :=
  match g with
  | Simple body => Some [body]
  | When condition g => if holds s [] condition then Some (found (walk s g)) else None
  | Goals k members =>
      Some ((fix through (gs : list goal) : list formula :=
        match gs with
        | [] => []
        | g :: gs =>
            match walk s g, k with
            | None, _ => through gs
            | Some bodies, Priority => bodies
            | Some bodies, Constraint => bodies ++ through gs
            end
        end) members)
  end.

(** The bodies of the simple goals active in [s]. *)
Definition active (s : state) : list formula :=
  match goals spec with None => [] | Some g => found (walk s g) end.

(** The goal of a run from [s] whose first set is [A] is met in [t]: state atoms are judged in [t], [Executing] in [A]. *)
Definition met (s : state) (A : actions) (t : state) : Prop := forall f, In f (active s) -> holds t A f = true.

(** ** 5. Policies *)

(** The state after [k] steps of the nominal run from [s]. *)
Fixpoint run (pi : policy) (s : state) (k : nat) : state :=
  match k with
  | 0 => s
  | S k => let here := run pi s k in delta here (pi here)
  end.

Definition within_bound (k : nat) : Prop :=
  match max_plan_length spec with None => True | Some most => (N.of_nat k <= most)%N end.

(** An effort is a duration and a number of steps (section 9): compared by duration, then by steps. *)
Definition effort := (N * N)%type.

Definition at_most (e f : effort) : Prop := (fst e < fst f \/ fst e = fst f /\ snd e <= snd f)%N.

(** The effort of a step with [A] and of [rest]. *)
Definition longer (A : actions) (rest : effort) : effort := (total_duration A + fst rest, 1 + snd rest)%N.

Definition no_effort : effort := (0, 0)%N.

(** Where a step leads: to any state of [next], or only to the nominal successor. *)
Definition leads := state -> actions -> state -> Prop.

Definition nominally : leads := fun s A t => t = delta s A.

(** [back_within to pi s e]: wherever the steps of [pi] from [s] lead, each of these ways comes to a restored state, with
    an effort of at most [e]. For [to := next] this says that [w(s)] is at most [e]; for [to := nominally], that the sum
    along the nominal run, until it is restored, is. What comes to no restored state is back within no effort. *)
Inductive back_within (to : leads) (pi : policy) : state -> effort -> Prop :=
| back s e (rest : state -> effort) :
    at_most (longer (pi s) no_effort) e ->
    (forall t, to s (pi s) t -> ~ restored s t -> at_most (longer (pi s) (rest t)) e) ->
    (forall t, to s (pi s) t -> ~ restored s t -> back_within to pi t (rest t)) ->
    back_within to pi s e.

(** The same, if in [s] the set [A] is taken once, and [pi] after that. *)
Definition back_after (to : leads) (pi : policy) (s : state) (A : actions) (e : effort) : Prop :=
  exists rest : state -> effort, at_most (longer A no_effort) e /\
    forall t, to s A t -> ~ restored s t -> at_most (longer A (rest t)) e /\ back_within to pi t (rest t).

Definition at_once (s : state) (A : actions) : Prop := forall t, next s A t -> restored s t.

(** What [pi] has to do in an unsafe state. ([ok] says it already under [OneStep].) *)
Definition restores (pi : policy) (s : state) : Prop :=
  match restored_in spec with
  | OneStep => at_once s (pi s)
  | Bounded => exists e, back_within next pi s e
  | Fair => exists e, back_within nominally pi s e
  end.

Definition sound_and_complete (pi : policy) : Prop :=
  forall s, valid s ->
    action_set (pi s) /\ ok s (pi s) /\ (~ safe s -> restores pi s) /\
    exists k, 1 <= k /\ within_bound k /\ safe (run pi s k) /\ met s (pi s) (run pi s k).

(** The policy that is [pi] but for the set [A] in [s]. *)
Definition change (pi : policy) (s : state) (A : actions) : policy :=
  fun t => if list_eq_dec Nat.eq_dec t s then A else pi t.

(** With [A] the least effort in question is smaller than with [B]. *)
Definition less_effort (to : leads) (pi : policy) (s : state) (A B : actions) : Prop :=
  exists e, back_after to pi s A e /\ ~ back_after to pi s B e.

Definition finite (pi : policy) (s : state) (A : actions) : Prop := exists e, back_after next pi s A e.

(** [A] restores [s] better than what [pi] does there. Under [OneStep]: its duration is smaller. *)
Definition better (pi : policy) (s : state) (A : actions) : Prop :=
  (at_once s A /\ ~ at_once s (pi s)) \/
  ((at_once s A <-> at_once s (pi s)) /\ less_effort next pi s A (pi s)) \/
  (restored_in spec = Fair /\ ~ finite pi s A /\ ~ finite pi s (pi s) /\ less_effort nominally pi s A (pi s)).

Definition minimal (pi : policy) : Prop :=
  forall s A, valid s -> ~ safe s -> action_set A -> ok s A -> better pi s A -> ~ sound_and_complete (change pi s A).

End Meaning.

(** ** 12. Start states *)

(** The same, where only the states of [D] are looked at. *)
Definition within (spec : specification) (D : state -> bool) : specification := {|
  sizes := sizes spec; declared := declared spec; reaction_rules := reaction_rules spec;
  state_rules := state_rules spec; assumptions := assumptions spec; goals := goals spec;
  max_plan_length := max_plan_length spec; restored_in := restored_in spec; throughout := throughout spec;
  starts := starts spec; part := D
|}.

(** Where there are no start conditions, every valid state is a start. *)
Definition start (spec : specification) (s : state) : Prop :=
  valid spec s /\ (starts spec = [] \/ exists f, In f (starts spec) /\ holds s [] f = true).

(** [pi], which decides the states of [D], is right: there are all starts among them, and valid states only; what
    sections 5 and 9 ask of valid states holds for these; and so, in particular, no step leads out of them. *)
Record right_from_starts (spec : specification) (order : ordering) (D : state -> bool) (pi : policy) : Prop := {
  starts_decided : forall s, start spec s -> D s = true;
  decided_valid : forall s, is_state spec s -> D s = true -> valid spec s;
  part_sound_and_complete : sound_and_complete (within spec D) order pi;
  part_minimal : minimal (within spec D) order pi
}.
