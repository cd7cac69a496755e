// What examples/ros2 uses of rclcpp, as ROS 2 Jazzy declares it: parameters come from -p NAME:=VALUE, a published message is printed.
#ifndef RCLCPP_RCLCPP_HPP
#define RCLCPP_RCLCPP_HPP

#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <string>

namespace rclcpp {

inline std::map<std::string, std::string> given;
inline volatile std::sig_atomic_t stopped = 0;

inline void init(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        const std::string word = argv[i];
        const auto at = word.find(":=");
        if (at != std::string::npos) {
            given[word.substr(0, at)] = word.substr(at + 2);
        }
    }
    std::signal(SIGTERM, [](int) { stopped = 1; });
}
inline bool ok() { return stopped == 0; }
inline bool shutdown() { return true; }

class Duration {
public:
    explicit Duration(std::chrono::nanoseconds length) : ns(length.count()) {}
    int64_t ns;
};

class Time {
public:
    int64_t ns = 0;
    Time operator-(const Duration &by) const { return Time{ns - by.ns}; }
};

class Logger {};
inline Logger get_logger(const std::string &) { return {}; }
class SensorDataQoS {};

template <typename Message> class Publisher {
public:
    using SharedPtr = std::shared_ptr<Publisher>;
    void publish(const Message &message) { print(message); }
};

class Node {
public:
    explicit Node(const std::string &) {}
    template <typename Value> Value declare_parameter(const std::string &name, const Value &otherwise)
    {
        const auto found = given.find(name);
        return found == given.end() ? otherwise : converted(found->second, otherwise);
    }
    template <typename Message> std::shared_ptr<Publisher<Message>> create_publisher(const std::string &, const SensorDataQoS &)
    {
        return std::make_shared<Publisher<Message>>();
    }
    Time now() const
    {
        return Time{std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count()};
    }
    Logger get_logger() const { return {}; }

private:
    static std::string converted(const std::string &text, const std::string &) { return text; }
    static int64_t converted(const std::string &text, int64_t) { return std::stoll(text); }
};

template <typename Any> void spin_some(const std::shared_ptr<Any> &) {}

} // namespace rclcpp

#define RCLCPP_INFO(logger, ...) ((void)(logger), std::fprintf(stderr, __VA_ARGS__), std::fputc('\n', stderr))
#define RCLCPP_ERROR RCLCPP_INFO

#endif
