// A node that executes the policy of amr.tum: actions by the action servers of the robot, the state by a service.

#include <array>
#include <chrono>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <rclcpp/rclcpp.hpp>
#include <rclcpp_action/rclcpp_action.hpp>

#include "amr_policy/action/execute.hpp"
#include "amr_policy/loop.hpp"
#include "amr_policy/srv/get_state.hpp"

namespace {

using namespace std::chrono_literals;
using amr_policy::Clock;
using amr_policy::action::Execute;
using amr_policy::srv::GetState;
using Client = rclcpp_action::Client<Execute>;
using Goal = rclcpp_action::ClientGoalHandle<Execute>;

constexpr auto period = 50ms; // between two questions for the state
constexpr amr_policy::Limits limits{1s, 10min, 30s};

/// The value that a word stands for. Other words leave the variable without one: the state is invalid then.
template <typename Value>
Value read(const std::string& word, std::initializer_list<std::pair<const char*, Value>> words)
{
    for (const auto& [known, value] : words) {
        if (word == known) {
            return value;
        }
    }
    return Value{-1};
}

amr::State state_of(const GetState::Response& said)
{
    using amr::S_Battery, amr::S_Conveyor, amr::S_Load, amr::S_Location;
    amr::State state;
    state.S_Location = read<S_Location>(
        said.location, {{"corridor", S_Location::corridor},
                        {"charger", S_Location::charger},
                        {"workstation_1", S_Location::workstation_1},
                        {"workstation_2", S_Location::workstation_2}});
    state.S_Battery = read<S_Battery>(said.battery, {{"low", S_Battery::low}, {"ok", S_Battery::ok}});
    state.S_Load = read<S_Load>(said.load, {{"loaded", S_Load::loaded}, {"free", S_Load::free}});
    state.S_Conveyor = read<S_Conveyor>(said.conveyor, {{"on", S_Conveyor::on}, {"off", S_Conveyor::off}});
    return state;
}

const char* reason(amr_policy::Stop stop)
{
    switch (stop) {
    case amr_policy::Stop::no: return "it has not stopped";
    case amr_policy::Stop::undecided: return "the specification excludes this state";
    case amr_policy::Stop::invalid: return "the state has a value that it cannot have";
    case amr_policy::Stop::stale: return "the state was not seen for too long";
    case amr_policy::Stop::no_result: return "an action has not ended in time";
    }
    return "";
}

class PolicyNode : public rclcpp::Node, public amr_policy::Robot {
public:
    PolicyNode() : rclcpp::Node("amr_policy"), state_{create_client<GetState>("get_state")}
    {
        for (const amr::Action action : amr::all_actions) {
            of(action).client = rclcpp_action::create_client<Execute>(this, amr::name(action));
        }
        timer_ = create_wall_timer(period, [this] { tick(); });
    }

private:
    /// An action of the robot. Results are promised only while somebody keeps the goal.
    struct Execution {
        Client::SharedPtr client;
        Goal::SharedPtr goal;
        bool halted = false;
    };

    Execution& of(amr::Action action) { return executions_[static_cast<std::size_t>(action)]; }

    void start(amr::Action action) override
    {
        RCLCPP_INFO(get_logger(), "start %s", amr::name(action));
        of(action).halted = false;
        Client::SendGoalOptions options;
        options.goal_response_callback = [this, action](Goal::SharedPtr goal) {
            if (!goal) {
                ended(action); // rejected: never begun
                return;
            }
            of(action).goal = goal;
            if (of(action).halted) {
                cancel(action);
            }
        };
        options.result_callback = [this, action](const Goal::WrappedResult& result) {
            if (result.code != rclcpp_action::ResultCode::UNKNOWN) {
                ended(action);
            } // else nobody knows whether it has ended: the loop stops when it has waited long enough
        };
        of(action).client->async_send_goal(Execute::Goal{}, options);
    }

    void halt(amr::Action action) override
    {
        RCLCPP_INFO(get_logger(), "halt %s", amr::name(action));
        of(action).halted = true; // where it is not accepted yet, it is cancelled once more as soon as it is
        cancel(action);
    }

    /// Whatever goals of an action there are: nobody else is to execute it.
    void cancel(amr::Action action) { of(action).client->async_cancel_all_goals(); }

    void ended(amr::Action action)
    {
        of(action).goal.reset();
        loop_->ended(action);
    }

    /// Nothing is done before the robot is complete: a goal that nobody hears is never answered.
    bool robot_is_there() const
    {
        for (const Execution& each : executions_) {
            if (!each.client->action_server_is_ready()) {
                return false;
            }
        }
        return state_->service_is_ready();
    }

    void tick()
    {
        const amr_policy::Time now = Clock::now();
        if (!loop_) {
            if (!robot_is_there()) {
                return;
            }
            loop_.emplace(*this, limits, now);
        }
        loop_->check(now);
        tell();
        if (!asked_ && loop_->stopped() == amr_policy::Stop::no) {
            asked_ = loop_->ask(now);
            state_->async_send_request(
                std::make_shared<GetState::Request>(),
                [this](rclcpp::Client<GetState>::SharedFuture answer) {
                    const amr_policy::Asked asked = *std::exchange(asked_, std::nullopt);
                    loop_->seen(state_of(*answer.get()), asked, Clock::now());
                    tell();
                });
        }
    }

    /// Say once that the loop has stopped. The node goes on, so that what was cancelled is.
    void tell()
    {
        if (!told_ && loop_->stopped() != amr_policy::Stop::no) {
            told_ = true;
            RCLCPP_FATAL(get_logger(), "stopped: %s. Call somebody.", reason(loop_->stopped()));
        }
    }

    std::array<Execution, amr::all_actions.size()> executions_{};
    rclcpp::Client<GetState>::SharedPtr state_;
    rclcpp::TimerBase::SharedPtr timer_;
    std::optional<amr_policy::Loop> loop_;
    std::optional<amr_policy::Asked> asked_;
    bool told_ = false;
};

} // namespace

int main(int argc, char** argv)
{
    rclcpp::init(argc, argv);
    rclcpp::spin(std::make_shared<PolicyNode>()); // one thread: its callbacks never run at the same time
    rclcpp::shutdown();
    return 0;
}
