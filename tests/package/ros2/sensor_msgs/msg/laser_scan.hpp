// sensor_msgs/LaserScan as ROS 2 generates it, and printed on a line of its own.
#ifndef SENSOR_MSGS_MSG_LASER_SCAN_HPP
#define SENSOR_MSGS_MSG_LASER_SCAN_HPP

#include <cstdio>
#include <rclcpp/rclcpp.hpp>
#include <string>
#include <vector>

namespace sensor_msgs::msg {

struct LaserScan {
    struct {
        rclcpp::Time stamp;
        std::string frame_id;
    } header;
    float angle_min, angle_max, angle_increment, time_increment, scan_time, range_min, range_max;
    std::vector<float> ranges, intensities;
};

inline void print(const LaserScan &scan)
{
    std::printf("%lld %s %.6f %.6f %.8f %.9f %.4f %.3f %.3f", static_cast<long long>(scan.header.stamp.ns), scan.header.frame_id.c_str(),
                scan.angle_min, scan.angle_max, scan.angle_increment, scan.time_increment, scan.scan_time, scan.range_min, scan.range_max);
    for (const float range : scan.ranges) {
        std::printf(" %.3f", range);
    }
    std::printf("\n");
    std::fflush(stdout);
}

} // namespace sensor_msgs::msg

#endif
