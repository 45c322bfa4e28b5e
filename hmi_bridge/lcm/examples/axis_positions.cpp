// Prints the positions of a machine's axes, and STALE when they are older than 500 ms: axis_positions DEMO
#include <chrono>
#include <cstdio>
#include <exception>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <string>
#include <taktwerk_lcm/axis_state_v1_t.hpp>

using taktwerk_lcm::axis_state_v1_t;
using Clock = std::chrono::steady_clock;

struct Positions {
    std::map<std::string, axis_state_v1_t> axes;  // the newest message of each
    Clock::time_point heard{};                    // by this computer's clock: that of the message may be another's
    void on_axis(const lcm::ReceiveBuffer* bytes, const std::string&) try {
        axis_state_v1_t axis;
        if (bytes->data_size > 4096 || axis.decode(bytes->data, 0, static_cast<int>(bytes->data_size)) < 0) return;
        axes[axis.name] = axis;
        heard = Clock::now();
    } catch (const std::exception&) {  // anybody may publish here: what lies about its lengths throws, and LCM is C
    }
};

int main(int argc, char** argv) {
    lcm::LCM lcm(argc > 2 ? argv[2] : "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=2097152");
    if (!lcm.good()) return std::fputs("no LCM: is there a route to 224.0.0.0/4?\n", stderr), 1;
    Positions positions;
    const auto channel = "TAKTWERK_" + std::string(argc > 1 ? argv[1] : "DEMO") + "_AXIS_STATE";
    lcm.subscribe(channel, &Positions::on_axis, &positions)->setQueueCapacity(256);  // one message an axis: room for all of them
    for (;;) {
        const auto next = Clock::now() + std::chrono::milliseconds(250);
        while (Clock::now() < next)
            if (lcm.handleTimeout(50) < 0) return 1;
        if (Clock::now() - positions.heard > std::chrono::milliseconds(500)) std::printf("STALE ");
        for (const auto& [name, axis] : positions.axes)
            std::printf("%s=%.6f %s%s  ", name.c_str(), axis.actual_position, axis.unit.c_str(), axis.powered ? "" : " (off)");
        std::printf("\n");
        std::fflush(stdout);
    }
}
