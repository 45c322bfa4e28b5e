// LCM over real UDP multicast, in a network namespace of the test's own; skipped where the system allows none.
#include <gmock/gmock.h>
#include <poll.h>
#include <unistd.h>

#include <string>

#include "hmi_bridge/hmi_bridge.hpp"
#include "hmi_bridge/lcm/lcm_bus.hpp"
#include "taktwerk_lcm/axis_state_v1_t.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"
#include "tests/hmi_bridge/own_network.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;

constexpr const char* url = "udpm://239.255.76.67:7667?ttl=0";

TEST(Multicast, WithoutARouteTheErrorNamesTheTwoCommandsThatMendIt) {
    RUN_IN_OWN_NETWORK([]() -> std::string {
        const auto bus = LcmBus::open(*parse_lcm_url(url));
        if (bus) return "LCM opened without a route";
        if (bus.error().code != "hmi.no_multicast_route") return bus.error().text();
        for (const auto* command : {"ip link set lo multicast on", "ip route add 224.0.0.0/4 dev lo"})
            if (bus.error().remedy.find(command) == std::string::npos) return "the remedy does not name " + std::string(command);
        return "";
    });
}

TEST(Multicast, WithoutARouteTheMachineRunsOnUnlessLcmIsRequired) {
    RUN_IN_OWN_NETWORK([]() -> std::string {
        test::FakeMachine machine;
        HmiConfig config;
        config.socket = "/tmp/taktwerk-multicast-test-" + std::to_string(::getpid());
        {
            auto bridge = HmiBridge::open(config, machine, {});
            if (!bridge) return "did not run on: " + bridge.error().text();
            if (!(*bridge)->lcm_problem()) return "no problem reported";
            (*bridge)->step(Instant{1s});
        }
        config.lcm_required = true;
        const auto required = HmiBridge::open(config, machine, {});
        if (required) return "ran without the required LCM";
        return required.error().code == "hmi.no_multicast_route" ? "" : required.error().text();
    });
}

TEST(Multicast, StateIsPublishedAndReceivedOnThisHost) {
    RUN_IN_OWN_NETWORK([]() -> std::string {
        if (!test::multicast_on()) return "skip";
        auto receiver = LcmBus::open(*parse_lcm_url(url));
        if (!receiver) return receiver.error().text();
        int axes = 0;
        std::string name;
        (*receiver)->subscribe("TAKTWERK_DEMO_AXIS_STATE", [&](std::span<const std::byte> bytes) {
            taktwerk_lcm::axis_state_v1_t message;
            if (message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) < 0) return;
            name = message.name;
            ++axes;
        });
        test::FakeMachine machine;
        HmiConfig config;
        config.socket = "/tmp/taktwerk-multicast-test-" + std::to_string(::getpid());
        auto bridge = HmiBridge::open(config, machine, {});
        if (!bridge) return bridge.error().text();
        if ((*bridge)->lcm_problem()) return (*bridge)->lcm_problem()->text();
        (*bridge)->step(Instant{1s});
        // Three datagrams through the kernel and LCM's thread: the pipe says when; ten seconds are for a machine under load.
        for (int round = 0; round < 1000 && axes < 3; ++round) {
            (*receiver)->poll(16);
            if (axes < 3) ::poll(nullptr, 0, 10);
        }
        if (axes != 3) return "received " + std::to_string(axes) + " of 3 axes";
        return name == "turret" ? "" : "wrong name " + name;
    });
}

}  // namespace
}  // namespace taktwerk::hmi
