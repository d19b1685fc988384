// Stands for what ROS generates from Execute.action.
#ifndef STUB_EXECUTE_HPP
#define STUB_EXECUTE_HPP

namespace amr_policy::action {

struct Execute {
    struct Goal {};
};

} // namespace amr_policy::action

#endif
