// Stands for the library in tests: see rclcpp.hpp.

#ifndef STUB_RCLCPP_ACTION_HPP
#define STUB_RCLCPP_ACTION_HPP

#include <cstdint>
#include <map>

#include "rclcpp/rclcpp.hpp"

namespace stub {

/// What became of the goals of one action.
struct Server {
    std::function<void(bool accepted)> respond; // to the latest goal
    std::function<void(std::int8_t code)> finish;
    int goals = 0;
    int cancels = 0;
};
inline std::map<std::string, Server> servers;

} // namespace stub

namespace rclcpp_action {

enum class ResultCode : std::int8_t { UNKNOWN = 0, SUCCEEDED = 4, CANCELED = 5, ABORTED = 6 };

template <typename Action>
struct ClientGoalHandle {
    using SharedPtr = std::shared_ptr<ClientGoalHandle>;
    struct WrappedResult {
        ResultCode code;
    };
};

template <typename Action>
struct Client {
    using SharedPtr = std::shared_ptr<Client>;
    using Goal = typename Action::Goal;
    using GoalHandle = ClientGoalHandle<Action>;
    struct SendGoalOptions {
        std::function<void(typename GoalHandle::SharedPtr)> goal_response_callback;
        std::function<void(const typename GoalHandle::WrappedResult&)> result_callback;
    };

    bool action_server_is_ready() const { return stub::services_are_ready; }

    void async_send_goal(const Goal&, const SendGoalOptions& options)
    {
        stub::Server& server = stub::servers[name];
        const auto kept = std::make_shared<std::weak_ptr<GoalHandle>>();
        ++server.goals;
        server.respond = [options, kept](bool accepted) {
            const auto goal = accepted ? std::make_shared<GoalHandle>() : nullptr;
            *kept = goal;
            options.goal_response_callback(goal);
        };
        server.finish = [options, kept](std::int8_t code) {
            if (!kept->expired()) { // as in the library: nobody waits for the result of a goal that was dropped
                options.result_callback({static_cast<ResultCode>(code)});
            }
        };
    }

    void async_cancel_all_goals() { ++stub::servers[name].cancels; }

    std::string name;
};

template <typename Action>
std::shared_ptr<Client<Action>> create_client(rclcpp::Node*, const std::string& name)
{
    return std::make_shared<Client<Action>>(Client<Action>{name});
}

} // namespace rclcpp_action

#endif
