// The node, driven by lines: t (timer), y/n ACTION (accepted or not), r ACTION CODE (result), s WORDS (the state),
// u/d (servers are up or down). After each line it prints the goals and the cancels of every action so far, and whether
// the state was asked for.

#include <iostream>

#include "node.cpp"

void stub::drive()
{
    std::string command, action;
    while (std::cin >> command) {
        if (command == "t") {
            stub::timer();
        } else if (command == "y" || command == "n") {
            std::cin >> action;
            stub::servers.at(action).respond(command == "y");
        } else if (command == "r") {
            int code = 0;
            std::cin >> action >> code;
            stub::servers.at(action).finish(static_cast<std::int8_t>(code));
        } else if (command == "s") {
            auto said = std::make_shared<amr_policy::srv::GetState::Response>();
            std::cin >> said->location >> said->battery >> said->load >> said->conveyor;
            const auto answer = std::exchange(stub::answer, nullptr);
            answer(said);
        } else {
            stub::services_are_ready = command == "u";
        }
        for (const auto& [name, server] : stub::servers) {
            std::cout << name << ' ' << server.goals << ' ' << server.cancels << ' ';
        }
        std::cout << (stub::answer ? "asked" : "idle") << std::endl;
    }
}
