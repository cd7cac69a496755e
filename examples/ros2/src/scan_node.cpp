// A Hokuyo scanner as a node of ROS 2: /scan, sensor_msgs/LaserScan, stamped with the time of its first ray.
//
// The sensor is first ordered as a URG-04LX and asked for its limits (PP), then ordered whole, by what it told.
#include <chrono>
#include <memory>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/laser_scan.hpp>
#include <stdexcept>
#include <string>
#include <vector>

extern "C" {
#include <plomada/scip_info.h>
#include <plomada/urg.h>

#include "board.h"
#include "laser_scan.h"
#include "posix.h"
}

namespace {

class ScanNode : public rclcpp::Node {
public:
    ScanNode() : Node("plomada_scip")
    {
        device_ = declare_parameter<std::string>("device", "/dev/ttyACM0");
        frame_ = declare_parameter<std::string>("frame_id", "laser");
        rate_ = static_cast<uint32_t>(declare_parameter<int64_t>("bit_rate", 0)); // 0: USB, which has none
        cluster_ = static_cast<uint16_t>(declare_parameter<int64_t>("cluster", 1));
        publisher_ = create_publisher<sensor_msgs::msg::LaserScan>("scan", rclcpp::SensorDataQoS());
        posix_use(device_.c_str());
        order(scip_limits_urg04lx);
        urg_ask(&urg_, &info_);
        board_uart_open(FIRST_RATE);
    }

    // Some milliseconds: octets in, and whatever they bring.
    void work()
    {
        octet_t octets[256];
        const size_t count = board_uart_read(octets, sizeof octets);

        if (urg_feed(&urg_, octets, count)) {
            urg_scan_at(&urg_, board_time_us());
            publish();
        }
        if (board_time_us() - stepped_us_ >= urg_pause_us(&urg_)) {
            step();
        }
        if (!known_ && urg_told(&urg_)) {
            know();
        }
    }

private:
    static constexpr uint32_t FIRST_RATE = 19200; // as delivered

    void order(const scip_limits_t &limits)
    {
        urg_config_t config = {};

        limits_ = limits;
        config.first_rate = FIRST_RATE;
        config.stream_rate = rate_ > 0 ? rate_ : 115200;
        config.stream = limits.dmax_mm > 4094 ? SCIP_STREAM_3 : SCIP_STREAM_2;
        config.range.first_step = limits.amin;
        config.range.last_step = whole_clusters(limits);
        config.range.cluster = cluster_;
        config.last_step = limits.amax;
        points_.resize(2U * (static_cast<size_t>(limits.amax) - limits.amin + 1U));
        const urg_refusal_t refusal = urg_refusal(&config, static_cast<uint16_t>(points_.size()));
        if (refusal != URG_ACCEPTED) {
            throw std::invalid_argument(urg_refusal_text(refusal));
        }
        (void)urg_init(&urg_, &config, points_.data(), static_cast<uint16_t>(points_.size()), board_time_us());
    }

    // Steps that fill no cluster make a point on some sensors and none on others.
    uint16_t whole_clusters(const scip_limits_t &limits) const
    {
        const unsigned steps = static_cast<unsigned>(limits.amax) - limits.amin + 1U;
        const unsigned cluster = cluster_ > 0 ? cluster_ : 1U;

        return static_cast<uint16_t>(limits.amin + steps / cluster * cluster - 1U);
    }

    void know()
    {
        known_ = true;
        RCLCPP_INFO(get_logger(), "%s, %s, %s", info_.product, info_.serial, info_.firmware);
        order(scip_info_limits(&info_));
        board_uart_open(FIRST_RATE);
    }

    void step()
    {
        urg_output_t output;

        stepped_us_ = board_time_us();
        urg_step(&urg_, stepped_us_);
        if (urg_next_to_send(&urg_, &output)) {
            if (output.set_rate) {
                board_uart_open(output.rate);
            }
            board_uart_write(output.octets, output.count);
        }
    }

    void publish()
    {
        scip_scan_t scan;

        if (!urg_take_scan(&urg_, &scan)) {
            return;
        }
        if (!known_) { // a question was lost on the line
            urg_ask(&urg_, &info_);
            return;
        }
        const laser_scan_shape_t shape = laser_scan_shape(&limits_, &scan, rate_);
        sensor_msgs::msg::LaserScan message;
        message.header.frame_id = frame_;
        message.header.stamp = now() - rclcpp::Duration(std::chrono::microseconds(shape.first_ray_age_us));
        message.angle_min = shape.angle_min;
        message.angle_max = shape.angle_max;
        message.angle_increment = shape.angle_increment;
        message.time_increment = shape.time_increment;
        message.scan_time = shape.scan_time;
        message.range_min = shape.range_min;
        message.range_max = shape.range_max;
        for (uint16_t i = 0; i < scan.points; i++) {
            message.ranges.push_back(laser_scan_range(&limits_, &scan, i));
        }
        publisher_->publish(message);
    }

    std::string device_, frame_;
    uint32_t rate_ = 0;
    uint16_t cluster_ = 1;
    rclcpp::Publisher<sensor_msgs::msg::LaserScan>::SharedPtr publisher_;
    std::vector<uint16_t> points_;
    urg_driver_t urg_ = {};
    scip_info_t info_ = {};
    scip_limits_t limits_ = {};
    bool known_ = false;
    uint32_t stepped_us_ = 0;
};

} // namespace

int main(int argc, char **argv)
{
    rclcpp::init(argc, argv);
    try {
        auto node = std::make_shared<ScanNode>();
        while (rclcpp::ok()) {
            node->work();
            rclcpp::spin_some(node);
        }
    } catch (const std::exception &error) {
        RCLCPP_ERROR(rclcpp::get_logger("plomada_scip"), "%s", error.what());
        return 1;
    }
    rclcpp::shutdown();
    return 0;
}
