// Stands for what ROS generates from GetState.srv.
#ifndef STUB_GET_STATE_HPP
#define STUB_GET_STATE_HPP

#include <string>

namespace amr_policy::srv {

struct GetState {
    struct Request {};
    struct Response {
        std::string location, battery, load, conveyor;
    };
};

} // namespace amr_policy::srv

#endif
