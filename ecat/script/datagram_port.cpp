#include "ecat/script/datagram_port.hpp"

#include <fmt/format.h>

namespace taktwerk::ecat {

Transfer::~Transfer() {
    if (entry_) channel_.release(*entry_);
}

std::optional<EntryId> Transfer::submit() noexcept { return channel_.submit_in_turn(turn_, command_, address_, data_, gate_); }

bool Transfer::withdraw() noexcept {
    if (!entry_ || !channel_.withdraw(*entry_)) return false;
    entry_.reset();
    return true;
}

/// All entries may be taken. That is nobody's silence: the time of the slave begins when its datagram is handed in. Only a line that does
/// not move at all is left, for then nobody moves frames; and a wait for a gate is limited whatever keeps it.
bool Transfer::stand_in_line(Instant now) {
    if (!in_line_since_) in_line_since_ = now;
    if (wait_ && !give_up_at_) give_up_at_ = now + *wait_;
    entry_ = submit();
    if (entry_) {
        reply_.queued += now - *in_line_since_;
        in_line_since_.reset();
        reply_.held = false;
        if (!give_up_at_) give_up_at_ = now + DatagramPort::patience;
        return false;
    }
    reply_.held = true;
    if (wait_) return now >= *give_up_at_;
    if (const auto moved = channel_.handed_out(); !line_seen_at_ || moved != line_seen_) {
        line_seen_ = moved;
        line_seen_at_ = now;
    }
    return now - *line_seen_at_ >= DatagramPort::patience;
}

bool Transfer::ready(Instant now) {
    if (!entry_) return stand_in_line(now);
    const auto answer = channel_.poll(*entry_);
    if (!answer && now < *give_up_at_) return false;
    if (!answer && wait_) {
        if (withdraw()) {
            reply_.held = true;
            return true;
        }
        if (now < *give_up_at_ + DatagramPort::patience) return false;  // it has left after all
    }
    if (answer && !answer->lost) {
        reply_ = Reply{false,           false,        answer->wkc, answer->slaves_passed, {answer->data.begin(), answer->data.end()},
                       answer->sent_at, reply_.queued};
    }
    channel_.release(*entry_);
    entry_.reset();
    if (reply_.lost && --attempts_ > 0 && now < *give_up_at_) {
        (void)stand_in_line(now);
        return false;
    }
    return true;
}

Error unanswered(const std::string& subject, const std::string& what, const Reply& reply) {
    if (reply.lost) {
        return Error{"bus.no_frame", subject, fmt::format("no frame came back for {}", what),
                     "check the cable between master and first slave; a computer that stood still meanwhile says so (late_wakeups)"};
    }
    if (reply.wkc == 0) {
        return Error{"bus.no_slave", subject, fmt::format("the slave did not answer to {} (working counter 0)", what),
                     "check its power and its cable; a slave that was power-cycled has lost its station address"};
    }
    return Error{"bus.working_counter", subject, fmt::format("{} slaves answered to {}, expected one", reply.wkc, what),
                 "two slaves have the same station address: restart the bus"};
}

}  // namespace taktwerk::ecat
