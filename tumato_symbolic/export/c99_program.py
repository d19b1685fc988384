"""The program that `c99_check` completes: what does not depend on the specification.

Longer than 300 lines because it is the text of one program, which is read and compiled as a whole.
"""

from typing import Final

PROGRAM: Final = """\
$about

   cc -std=c99 -O2 -o check ${name}_check.c $name.c && ./check

   What is judged is the compiled policy, and not the code of the robot: that must ask only when nothing is being
   executed, see every effect before it asks again, and keep an action that it halted from having an effect later. */

#include "$name.h"
#include <stdio.h>
#include <string.h>

enum {
    STATES = $state_count,
    VARIABLES = $variable_count,
    ACTIONS = $action_count,
    REQUIRED = $required_count,
    GOALS = $goal_count,
    LEVELS = $level_count,        /* how many severities of state rules there are */
    BOUND = $bound,               /* max_plan_length; 0 where there is none */
    ONE_EFFECT = $one_effect,     /* whether a step ends with the first effect */
    SEVERAL_STEPS = $several_steps, /* whether safety may take several steps to restore */
    FAIR = $fair,                 /* whether nominal effects may be needed for that */
    STARTS = $starts,             /* whether only starts have to be decided, and what may follow */
    LASTING = $preconditions_last, /* whether preconditions have to hold until an action takes effect */
    LARGEST = $largest            /* how many actions with effects are decided together at most */
};

typedef struct {
    int values[VARIABLES];
} world;

typedef struct {
    char executed[ACTIONS];
} set;

static const int sizes[] = { $sizes };
static const char *const variable_names[] = { $variable_names };
$value_names
/* Pairs of variable and value; where in them each effect begins and ends; where in those an action's effects do. */
$tables
static int is_assumed(const world *w)
{
    const int *const s = w->values;
    (void)s;
    return $valid;
}

static int is_start(const world *w)
{
    const int *const s = w->values;
    (void)s;
    return $start;
}

static ${p}_status ask(const world *w, ${p}_actions *actions)
{
    const int *const s = w->values;
    ${p}_state state;
    (void)s;
$fields    return ${p}_decide(&state, actions);
}

static int is_decided(const world *w)
{
    ${p}_actions actions;
    return ask(w, &actions) == ${u}_DECIDED;
}

/* Whether a state is one of those that are looked at. */
static int is_valid(const world *w)
{
    return is_assumed(w) && (!STARTS || is_decided(w));
}

/* How many severities, the most severe first, have all their rules satisfied. */
static int level(const world *w)
{
    const int *const s = w->values;
    (void)s;
$levels    return LEVELS;
}

static int is_safe(const world *w)
{
    return is_valid(w) && level(w) == LEVELS;
}

/* Whether an action may start here; or, where it was started before, whether it may still take effect. */
static int is_possible(int action, int started, const int *s)
{
    (void)s;
    (void)started;
    switch (action) {
$preconditions    default: return 1;
    }
}

/* What the policy decides; `possible` tells whether all of it can start. */
static ${p}_status decide(const world *w, set *decided, int *possible)
{
    const int *const s = w->values;
    char *const chosen = decided->executed;
    ${p}_actions actions;
    const ${p}_status status = ask(w, &actions);
    memset(decided, 0, sizeof *decided);
    *possible = 1;
    (void)s;
    (void)chosen;
    if (status != ${u}_DECIDED) return status;
$chosen    return status;
}

static int reaction_rules_hold(const world *w, const set *decided)
{
    const int *const s = w->values;
    const char *const chosen = decided->executed;
    (void)s;
    (void)chosen;
    return $reaction_rules;
}

/* Which rules every state that a step from here leads to has to satisfy. */
static void require(const world *w, char *when)
{
    const int *const s = w->values;
    (void)s;
    (void)when;
$when}

static int is_as_required(const world *w, const char *when)
{
    const int *const s = w->values;
    (void)s;
    (void)when;
$required    return !STARTS || is_decided(w);
}

static void activate(const world *w, char *active)
{
    const int *const s = w->values;
    (void)s;
    (void)active;
$active}

/* Whether the goals that were active when `first` was decided are met here. */
static int is_met(const world *w, const char *active, const set *first)
{
    const int *const s = w->values;
    const char *const chosen = first->executed;
    (void)s;
    (void)active;
    (void)chosen;
    if (SEVERAL_STEPS && !is_safe(w)) return 0;
$goals    return 1;
}

/* One effect. */
static void take(world *w, int effect)
{
    (void)w;
    switch (effect) {
$take    default: break;
    }
}

static void take_nominal(world *w, int action)
{
    (void)w;
    switch (action) {
$take_nominal    default: break;
    }
}

static world after_nominal(const world *w, const set *decided)
{
    world after = *w;
    int action;
    for (action = 0; action < ACTIONS; action++) {
        if (decided->executed[action]) take_nominal(&after, action);
    }
    return after;
}

static int nominal_agrees(const set *decided)
{
    int written[VARIABLES];
    int action, place;
    memset(written, 0, sizeof written);
    for (action = 0; action < ACTIONS; action++) {
        if (!decided->executed[action]) continue;
        for (place = nominal_of[action][0]; place < nominal_of[action][1]; place++) {
            int *const known = &written[assignments[place][0]];
            const int value = assignments[place][1] + 1;
            if (*known != 0 && *known != value) return 0;
            *known = value;
        }
    }
    return 1;
}

static int are_compatible(const set *decided)
{
    const char *const chosen = decided->executed;
    (void)chosen;
$excluded    return 1;
}

/* Whether no variable is written by effects of two of the actions: then the order of effects makes no difference. */
static int are_independent(const set *decided)
{
    int writer[VARIABLES];
    int action, effect, place;
    memset(writer, 0, sizeof writer);
    for (action = 0; action < ACTIONS; action++) {
        if (!decided->executed[action]) continue;
        for (effect = effects_of[action][0]; effect < effects_of[action][1]; effect++) {
            for (place = effects[effect][0]; place < effects[effect][1]; place++) {
                int *const known = &writer[assignments[place][0]];
                if (*known != 0 && *known != action + 1) return 0;
                *known = action + 1;
            }
        }
    }
    return 1;
}

/* How many effects have been looked at. */
static unsigned long seen;

typedef int (*judge)(const world *after, const set *waiting, const void *data);

/* Whether `holds` does after every effect; `first` is the first action that may still take effect. */
static int after_effects(const world *w, const set *waiting, int first, int in_order, judge holds, const void *data)
{
    int action, effect;
    for (action = first; action < ACTIONS; action++) {
        set left = *waiting;
        if (!waiting->executed[action]) continue;
        left.executed[action] = 0;
        for (effect = effects_of[action][0]; effect < effects_of[action][1]; effect++) {
            world after = *w;
            take(&after, effect);
            seen++;
            if (!holds(&after, &left, data)) return 0;
            if (ONE_EFFECT) continue;
            if (!after_effects(&after, &left, in_order ? action + 1 : 0, in_order, holds, data)) return 0;
        }
    }
    return 1;
}

/* Whether `holds` does in every state in which the next decision may be taken. */
static int everywhere_next(const world *w, const set *decided, judge holds, const void *data)
{
    const set nothing = { { 0 } };
    const unsigned long before = seen;
    world end;
    if (!after_effects(w, decided, 0, are_independent(decided), holds, data)) return 0;
    if (seen == before && !holds(w, &nothing, data)) return 0;
    end = after_nominal(w, decided);
    return holds(&end, &nothing, data);
}

static int stays_as_required(const world *after, const set *waiting, const void *when)
{
    int action;
    if (!is_as_required(after, when)) return 0;
    for (action = 0; LASTING && action < ACTIONS; action++) {
        if (waiting->executed[action] && !is_possible(action, 1, after->values)) return 0;
    }
    return 1;
}

static int is_allowed(const world *w, const set *decided, int possible)
{
    char when[REQUIRED] = { 0 };
    if (!possible || !are_compatible(decided) || !reaction_rules_hold(w, decided)) return 0;
    require(w, when);
    return everywhere_next(w, decided, stays_as_required, when);
}

#ifdef PROVE

/* For a bounded model checker: any valid state, any order of effects. What it proves is that every such state is
   decided (with starts: every start, and no state that is not valid), that the decision is allowed, and that every
   outcome is as required (with starts: decided, too). */

#include <assert.h>

int __VERIFIER_nondet_int(void);

int main(void)
{
    world w, end;
    set decided;
    char when[REQUIRED] = { 0 };
    int variable, possible, step, action, waiting = 0;
    const set nothing = { { 0 } };
    for (variable = 0; variable < VARIABLES; variable++) {
        w.values[variable] = __VERIFIER_nondet_int();
        if (w.values[variable] < 0 || w.values[variable] >= sizes[variable]) return 0;
    }
    if (STARTS && !is_decided(&w)) {
        assert(!(is_assumed(&w) && is_start(&w)));
        return 0;
    }
    if (!is_assumed(&w)) {
        assert(!STARTS);
        return 0;
    }
    assert(decide(&w, &decided, &possible) == ${u}_DECIDED);
    assert(possible);
    assert(are_compatible(&decided));
    assert(reaction_rules_hold(&w, &decided));
    require(&w, when);
    end = after_nominal(&w, &decided);
    assert(stays_as_required(&end, &nothing, when));
    for (action = 0; action < ACTIONS; action++) {
        waiting += decided.executed[action] && effects_of[action][0] < effects_of[action][1];
    }
    assert(waiting <= LARGEST);
    for (step = 0; step < (ONE_EFFECT ? 1 : LARGEST); step++) {
        const int effect = __VERIFIER_nondet_int();
        switch (effect) {
$spend        default: return 0;
        }
        take(&w, effect);
        assert(stays_as_required(&w, &decided, when));
    }
    return 0;
}

#else

static unsigned long longest;

/* Whether the nominal run meets its goals; where `above` is not negative, whether it raises the level above that. */
static int run_succeeds(const world *w, const set *decided, int above)
{
    char active[GOALS] = { 0 };
    const set first = *decided;
    set now = *decided;
    world here = *w, met = *w;
    unsigned long steps = 0, next_met = 1;
    int possible;
    activate(w, active);
    for (;;) {
        here = after_nominal(&here, &now);
        steps++;
        if (above >= 0 ? is_valid(&here) && level(&here) > above : is_met(&here, active, &first)) break;
        if (above < 0 && BOUND != 0 && steps == (unsigned long)BOUND) return 0;
        if (steps > 1 && memcmp(&here, &met, sizeof here) == 0) return 0;
        if (steps == next_met) {
            met = here;
            next_met *= 2;
        }
        if (!is_valid(&here) || decide(&here, &now, &possible) != ${u}_DECIDED || !nominal_agrees(&now)) return 0;
    }
    if (above < 0 && steps > longest) longest = steps;
    return 1;
}

/* Which unsafe states are known to be restored, whatever effects occur. */
static char is_restored[STATES];

static unsigned long number_of(const world *w)
{
    unsigned long number = 0;
    int variable;
    for (variable = 0; variable < VARIABLES; variable++) {
        number = number * (unsigned long)sizes[variable] + (unsigned long)w->values[variable];
    }
    return number;
}

static void world_of(unsigned long number, world *w)
{
    int variable;
    for (variable = VARIABLES - 1; variable >= 0; variable--) {
        w->values[variable] = (int)(number % (unsigned long)sizes[variable]);
        number /= (unsigned long)sizes[variable];
    }
}

static int is_restored_then(const world *after, const set *waiting, const void *before)
{
    (void)waiting;
    return is_valid(after) && (level(after) > *(const int *)before || is_restored[number_of(after)]);
}

static void find_restored(void)
{
    unsigned long number;
    int changed = 1;
    while (changed) {
        changed = 0;
        for (number = 0; number < STATES; number++) {
            world w;
            set decided;
            int now, possible;
            world_of(number, &w);
            if (is_restored[number] || !is_valid(&w)) continue;
            now = level(&w);
            if (now == LEVELS || decide(&w, &decided, &possible) != ${u}_DECIDED) continue;
            if (!nominal_agrees(&decided) || !everywhere_next(&w, &decided, is_restored_then, &now)) continue;
            is_restored[number] = 1;
            changed = 1;
        }
    }
}

static void show(const char *what, const world *w, unsigned long *count)
{
    int variable;
    if (++*count > 5) return;
    printf("%s:", what);
    for (variable = 0; variable < VARIABLES; variable++) {
        printf(" %s=%s", variable_names[variable], value_names[variable][w->values[variable]]);
    }
    puts("");
}

int main(void)
{
    unsigned long number, valid = 0, safe = 0, missing = 0, forbidden = 0, lost = 0, trapped = 0;
    unsigned long starts = 0, decisions = 0, invalid = 0;
    if (SEVERAL_STEPS) find_restored();
    seen = 0;
    for (number = 0; number < STATES; number++) {
        world w;
        set decided;
        int possible;
        world_of(number, &w);
        if (!is_assumed(&w)) {
            if (STARTS && is_decided(&w)) show("decided, but not valid", &w, &invalid);
            continue;
        }
        valid++;
        starts += (unsigned long)is_start(&w);
        safe += (unsigned long)(level(&w) == LEVELS);
        if (decide(&w, &decided, &possible) != ${u}_DECIDED) {
            if (is_start(&w)) show("undecided", &w, &missing);
            continue;
        }
        decisions++;
        if (!is_allowed(&w, &decided, possible)) {
            show("not allowed", &w, &forbidden);
        } else if (!run_succeeds(&w, &decided, -1)) {
            show("goals not reached", &w, &lost);
        }
        if (SEVERAL_STEPS && !is_safe(&w) && nominal_agrees(&decided) && !is_restored[number]
            && !(FAIR && run_succeeds(&w, &decided, level(&w)))) {
            show("safety not restored", &w, &trapped);
        }
    }
    printf("%d states, %lu valid, %lu safe; %lu effects; longest run to a goal: %lu\\n", (int)STATES, valid, safe,
           seen, longest);
    printf("undecided %lu, not allowed %lu, goals not reached %lu, safety not restored %lu\\n", missing, forbidden,
           lost, trapped);
    if (STARTS) {
        printf("starts %lu, valid states decided %lu, others decided %lu\\n", starts, decisions, invalid);
    }
    return missing + invalid + forbidden + lost + trapped != 0;
}

#endif
"""
