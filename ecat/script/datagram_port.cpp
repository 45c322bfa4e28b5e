#include "ecat/script/datagram_port.hpp"

#include <fmt/format.h>

namespace taktwerk::ecat {

Transfer::~Transfer() {
    if (entry_) channel_.release(*entry_);
}

bool Transfer::ready(Instant now) {
    if (!give_up_at_) give_up_at_ = now + DatagramPort::patience;
    if (!entry_) {
        entry_ = channel_.submit(command_, address_, data_);
        if (!entry_) return now >= *give_up_at_;  // all entries taken: wait for one
        return false;
    }
    const auto answer = channel_.poll(*entry_);
    if (!answer && now < *give_up_at_) return false;
    if (answer && !answer->lost) {
        reply_ = Reply{false, answer->wkc, answer->slaves_passed, {answer->data.begin(), answer->data.end()}, answer->sent_at};
    }
    channel_.release(*entry_);
    entry_.reset();
    if (reply_.lost && --attempts_ > 0 && now < *give_up_at_) {
        entry_ = channel_.submit(command_, address_, data_);
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
