#include "ecat/script/datagram_port.hpp"

#include <fmt/format.h>

namespace taktwerk::ecat {

Transfer::~Transfer() {
    if (entry_) channel_.release(*entry_);
}

std::optional<EntryId> Transfer::submit() noexcept {
    return gate_.exists() ? channel_.submit_gated(command_, address_, data_, gate_) : channel_.submit(command_, address_, data_);
}

bool Transfer::withdraw() noexcept {
    if (!entry_ || !channel_.withdraw(*entry_)) return false;
    entry_.reset();
    return true;
}

bool Transfer::ready(Instant now) {
    if (!give_up_at_) give_up_at_ = now + wait_.value_or(DatagramPort::patience);
    if (!entry_) {
        entry_ = submit();
        reply_.held = !entry_;
        return !entry_ && now >= *give_up_at_;  // all entries taken: wait for one
    }
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
        reply_ = Reply{false, false, answer->wkc, answer->slaves_passed, {answer->data.begin(), answer->data.end()}, answer->sent_at};
    }
    channel_.release(*entry_);
    entry_.reset();
    if (reply_.lost && --attempts_ > 0 && now < *give_up_at_) {
        entry_ = submit();
        return false;
    }
    return true;
}

Error unanswered(const std::string& subject, const std::string& what, const Reply& reply) {
    if (reply.lost) {
        return Error{"bus.no_frame", subject, fmt::format("no frame came back for {}", what),
                     "check the cable between master and first slave, and that the cycle or pump() is running"};
    }
    if (reply.wkc == 0) {
        return Error{"bus.no_slave", subject, fmt::format("the slave did not answer to {} (working counter 0)", what),
                     "check its power and its cable; a slave that was power-cycled has lost its station address"};
    }
    return Error{"bus.working_counter", subject, fmt::format("{} slaves answered to {}, expected one", reply.wkc, what),
                 "two slaves have the same station address: restart the bus"};
}

}  // namespace taktwerk::ecat
