// Stands for the library in tests: as much of it as examples/ros2 uses. What it would do is left to `stub`.

#ifndef STUB_RCLCPP_HPP
#define STUB_RCLCPP_HPP

#include <chrono>
#include <cstdio>
#include <functional>
#include <future>
#include <memory>
#include <string>

#define RCLCPP_INFO(logger, ...) (static_cast<void>(logger), std::fprintf(stderr, __VA_ARGS__), std::fputs("\n", stderr))
#define RCLCPP_FATAL(logger, ...) RCLCPP_INFO(logger, __VA_ARGS__)

namespace stub {
inline std::function<void()> timer;                                           // the only one
inline std::function<void(const std::shared_ptr<void>& response)> answer; // to the latest request
inline bool services_are_ready = true;
void drive(); // while the node spins
} // namespace stub

namespace rclcpp {

struct Logger {};

struct TimerBase {
    using SharedPtr = std::shared_ptr<TimerBase>;
};

template <typename Service>
struct Client {
    using SharedPtr = std::shared_ptr<Client>;
    using SharedFuture = std::shared_future<std::shared_ptr<typename Service::Response>>;

    bool service_is_ready() const { return stub::services_are_ready; }

    void async_send_request(
        const std::shared_ptr<typename Service::Request>&, const std::function<void(SharedFuture)>& callback)
    {
        stub::answer = [callback](const std::shared_ptr<void>& response) {
            std::promise<std::shared_ptr<typename Service::Response>> promise;
            promise.set_value(std::static_pointer_cast<typename Service::Response>(response));
            callback(promise.get_future().share());
        };
    }
};

class Node {
public:
    explicit Node(const std::string&) {}
    Logger get_logger() const { return {}; }

    template <typename Service>
    std::shared_ptr<Client<Service>> create_client(const std::string&)
    {
        return std::make_shared<Client<Service>>();
    }

    TimerBase::SharedPtr create_wall_timer(std::chrono::milliseconds, std::function<void()> callback)
    {
        stub::timer = std::move(callback);
        return std::make_shared<TimerBase>();
    }
};

inline void init(int, char**) {}
inline void shutdown() {}
inline void spin(const std::shared_ptr<Node>&) { stub::drive(); }

} // namespace rclcpp

#endif
