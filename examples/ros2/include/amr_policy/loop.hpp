// The loop that executes a policy. docs/robot.md says what it has to do, and why; README.md what it asks of a robot.
//
// It knows nothing of ROS, never waits, reads no clock, and is to be called by one thread at a time.

#ifndef AMR_POLICY_LOOP_HPP
#define AMR_POLICY_LOOP_HPP

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "amr_policy/amr.hpp"

namespace amr_policy {

using Clock = std::chrono::steady_clock;
using Time = Clock::time_point;

/// What the loop needs of a robot. Neither function waits; either may call `Loop::ended`.
class Robot {
public:
    virtual ~Robot() = default;

    /// Begin an action. `Loop::ended` has to be called once, however it ends.
    virtual void start(amr::Action action) = 0;

    /// End an action as soon as it can be; `Loop::ended` is called when it can have no effect any more.
    virtual void halt(amr::Action action) = 0;
};

/// How long the loop waits before it stops.
struct Limits {
    Clock::duration state;   ///< since the newest state that it has seen was asked for
    Clock::duration action;  ///< for an action to end by itself
    Clock::duration halting; ///< for actions to end that are halted
};

/// Why the loop has stopped. Nothing is started any more then; what runs is halted.
enum class Stop {
    no,
    undecided, ///< the specification excludes the state: its assumptions are wrong, or the sensors are
    invalid,   ///< some variable has none of its values
    stale,     ///< no state was seen for too long
    no_result  ///< an action has not ended in time: nobody knows what it will still do
};

/// When a state was asked for: at what time, and after how many actions had ended.
struct Asked {
    Time at;
    std::uint64_t endings;
};

class Loop {
public:
    Loop(Robot& robot, const Limits& limits, Time now) noexcept : robot_{robot}, limits_{limits}, newest_{now} {}

    /// Note this before you ask for the state, and give it to `seen` with the answer.
    Asked ask(Time now) const noexcept { return {now, endings_}; }

    /// A state as it was at some moment since it was asked for. Call this again and again, whatever runs.
    void seen(const amr::State& state, const Asked& asked, Time now)
    {
        // What was asked for before an action ended may miss an effect of it.
        if (asked.endings != endings_ || asked.at < newest_) {
            return;
        }
        newest_ = asked.at;
        check(now);
        if (stopped_ != Stop::no) {
            return;
        }
        const amr::Decision decision = amr::decide(state);
        if (decision.status != amr::Status::decided) {
            stop(decision.status == amr::Status::undecided ? Stop::undecided : Stop::invalid, now);
        } else if (!runs_just(decision.actions)) {
            if (runs_just({})) {
                start(decision.actions, now);
            } else {
                halt(now); // and only when all have ended, and a state was seen since, start something else
            }
        }
    }

    /// An action has succeeded, failed, was halted or never begun: from now on it has no effect.
    void ended(amr::Action action) noexcept
    {
        ++endings_;
        started(action).reset();
        if (runs_just({})) {
            halting_since_.reset();
        }
    }

    /// Stop where something took too long. Call this again and again.
    void check(Time now)
    {
        if (stopped_ != Stop::no) {
            return;
        }
        bool overdue = halting_since_ && now - *halting_since_ > limits_.halting;
        for (const std::optional<Time>& since : started_) {
            overdue = overdue || (since && now - *since > limits_.action);
        }
        if (overdue) {
            stop(Stop::no_result, now);
        } else if (now - newest_ > limits_.state) {
            stop(Stop::stale, now);
        }
    }

    Stop stopped() const noexcept { return stopped_; }

private:
    std::optional<Time>& started(amr::Action action) noexcept { return started_[static_cast<std::size_t>(action)]; }

    bool runs_just(const amr::Actions& actions) const noexcept
    {
        for (const amr::Action action : amr::all_actions) {
            if (started_[static_cast<std::size_t>(action)].has_value() != actions.contains(action)) {
                return false;
            }
        }
        return true;
    }

    void start(const amr::Actions& actions, Time now)
    {
        for (const amr::Action action : amr::all_actions) {
            if (actions.contains(action)) {
                started(action) = now;
            }
        }
        for (const amr::Action action : amr::all_actions) {
            if (actions.contains(action)) {
                robot_.start(action);
            }
        }
    }

    void halt(Time now)
    {
        if (halting_since_) {
            return;
        }
        halting_since_ = now;
        for (const amr::Action action : amr::all_actions) {
            if (started(action)) {
                robot_.halt(action);
            }
        }
    }

    void stop(Stop why, Time now)
    {
        stopped_ = why;
        halt(now);
    }

    Robot& robot_;
    Limits limits_;
    Time newest_;                                                        ///< when the newest state was asked for
    std::uint64_t endings_ = 0;                                          ///< how many actions have ended
    std::array<std::optional<Time>, amr::all_actions.size()> started_{}; ///< of the actions that run, since when
    std::optional<Time> halting_since_;
    Stop stopped_ = Stop::no;
};

} // namespace amr_policy

#endif
