#pragma once
// What both rigs of persons at a group begin with: a machine of config/machines/ with a gateway beside it, in virtual time, two panels, and a command with its answer.

#include <functional>
#include <map>
#include <string>

#include "hmi_bridge/gateway/gateway.hpp"
#include "hmi_bridge/runtime_link.hpp"
#include "tests/programs/examples/example_machine.hpp"

namespace taktwerk::group_hand {

using namespace std::chrono_literals;
using hmi::CommandKind;
using runtime::Answer;
using runtime::Mode;

class GatewayHand {
public:
    GatewayHand(const std::string& machine, const std::function<void(runtime::MachineConfig&)>& change) : m{machine, change} {
        a = open("panel A");
        b = open("panel B");
    }
    virtual ~GatewayHand() { m.each_cycle = {}; }
    GatewayHand(const GatewayHand&) = delete;
    GatewayHand& operator=(const GatewayHand&) = delete;

    hmi::ClientId open(const std::string& name) { return gateway.open(hmi::Source::socket, name, hmi::Rights::commissioning); }

    /// One cycle of the machine, and of the gateway beside it.
    void step() {
        gateway.observe(true);
        gateway.step(m.now());
        while (auto reply = gateway.next_reply()) {
            replies[{reply->client, reply->sequence}] = *reply;
            answered(*reply);
        }
        m.run(1ms);
    }
    void run(Duration time) {
        for (auto end = m.now() + time; m.now() < end;) step();
    }
    bool until(const std::function<bool()>& condition, Duration most) {
        for (auto end = m.now() + most; m.now() < end && !condition();) step();
        return condition();
    }

    /// Handed over in this cycle; the answer comes with a later one.
    std::uint64_t send(hmi::CommandRequest request, hmi::ClientId client) {
        request.client = client;
        request.sequence = ++sequence;
        request.arrival.after = m.machine().levels_raised();
        sends(request);
        gateway.observe(true);
        gateway.handle(request, m.now());
        return sequence;
    }
    hmi::CommandReply reply(hmi::ClientId client, std::uint64_t of) {
        EXPECT_TRUE(until([&] { return replies.count({client, of}) != 0; }, 3s));
        return replies[{client, of}];
    }
    hmi::CommandReply order(hmi::ClientId client, CommandKind kind, const std::string& target, double value = 0, double value2 = 0) {
        hmi::CommandRequest request;
        request.kind = kind;
        request.target = target;
        request.value = value;
        request.value2 = value2;
        return reply(client, send(request, client));
    }
    static hmi::CommandRequest mode_request(Mode wanted) {
        hmi::CommandRequest request;
        request.kind = CommandKind::mode;
        request.mode = wanted;
        return request;
    }
    hmi::CommandReply mode(Mode wanted) { return reply(a, send(mode_request(wanted), a)); }
    /// Held for 250 ms, unless it is renewed.
    static hmi::CommandRequest jog_request_of(const std::string& group, const std::string& frame, const std::string& direction,
                                              double velocity, double distance, bool press) {
        hmi::CommandRequest request;
        request.kind = CommandKind::group_jog;
        request.target = group;
        request.value = velocity;
        request.press = press;
        request.valid_for = 250ms;
        request.group_jog = {frame, direction, distance};
        return request;
    }
    const runtime::SeenGroup& seen() { return m.snapshot().groups[0]; }

    testing::ExampleMachine m;
    hmi::RuntimeLink link{m.machine()};
    hmi::Gateway gateway{link};
    hmi::ClientId a = 0, b = 0;
    std::uint64_t sequence = 0;
    std::map<std::pair<hmi::ClientId, std::uint64_t>, hmi::CommandReply> replies;

protected:
    /// For who keeps a book of what was asked and what came of it.
    virtual void sends(const hmi::CommandRequest& /*request*/) {}
    virtual void answered(const hmi::CommandReply& /*reply*/) {}
};

}  // namespace taktwerk::group_hand
