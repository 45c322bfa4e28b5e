#include "hmi_bridge/lcm/whole_publisher.hpp"

#include <algorithm>

#include "hmi_bridge/command_words.hpp"
#include "hmi_bridge/lcm/channels.hpp"
#include "hmi_bridge/lcm/whole_message.hpp"

namespace taktwerk::hmi {

WholePublisher::WholePublisher(MessageBus& bus, const MachineLink& machine, Duration period, std::int64_t run, NameOfClient who)
    : bus_(bus),
      machine_(machine),
      channel_(Channels(machine.layout().machine).whole_state()),
      period_(std::max(period, least_period)),
      who_(std::move(who)) {
    message_.run = run;
}

bool WholePublisher::due(Instant now) {
    if (now < next_) return false;
    next_ += period_;
    if (next_ <= now) next_ = now + period_;  // what was missed is not made up for
    return true;
}

bool WholePublisher::publish(const runtime::Snapshot& snapshot, std::int64_t seq, std::int64_t utime) {
    fill(message_, snapshot, machine_, who_);
    message_.utime = utime;
    message_.seq = seq;
    message_.protocol_version = protocol_version;
    ++message_.publication;
    message_.check = 0;
    const auto bytes = write_whole_state(message_, buffer_);
    return !bytes.empty() && bus_.publish(channel_, bytes);
}

}  // namespace taktwerk::hmi
