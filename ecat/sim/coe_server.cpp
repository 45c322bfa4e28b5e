#include "ecat/sim/coe_server.hpp"

#include <algorithm>

#include "ecat/wire/mailbox.hpp"
#include "ecat/wire/sdo.hpp"

namespace taktwerk::ecat::sim {

namespace {

unsigned position_of(const DeviceDescription& description, SmUse use, unsigned otherwise) {
    for (std::size_t n = 0; n < description.sync_managers.size(); ++n)
        if (description.sync_managers[n].use == use) return static_cast<unsigned>(n);
    return otherwise;
}

std::size_t size_of(const DeviceDescription& description, unsigned n) {
    return n < description.sync_managers.size() ? description.sync_managers[n].size : 0;
}

}  // namespace

CoeServer::CoeServer(const DeviceDescription& description, ObjectDictionary& dictionary, DeviceModel& model, SlaveController& controller,
                     Duration response_delay)
    : description_(description),
      controller_(controller),
      sdo_(description, dictionary, model),
      out_sm_(position_of(description, SmUse::mailbox_out, 0)),
      in_sm_(position_of(description, SmUse::mailbox_in, 1)),
      response_delay_(response_delay) {
    const std::size_t slots = std::max<std::size_t>(1, description.mailbox ? description.mailbox->max_pending : 1);
    queue_.resize(slots);
    for (auto& slot : queue_) slot.bytes.resize(std::max<std::size_t>(mailbox_header_size, size_of(description, out_sm_)));
    reply_.resize(std::max<std::size_t>(mailbox_header_size, size_of(description, in_sm_)));
    last_reply_.resize(reply_.size());
}

void CoeServer::start() noexcept {
    head_ = count_ = 0;
    reply_waiting_ = last_reply_valid_ = false;
    last_counter_ = counter_ = 0;
    due_ = never;
    running_ = true;
    sdo_.reset();
}

void CoeServer::stop() noexcept {
    running_ = false;
    due_ = never;
}

Instant CoeServer::next_event() const noexcept { return running_ && !stuck_ && !reply_waiting_ ? due_ : never; }

void CoeServer::step(EsmState state, Instant now) noexcept {
    if (!running_ || stuck_) return;
    if (controller_.repeat_requested(in_sm_)) {
        // The answer was lost on the wire: the same bytes once more, then the acknowledge bit follows the request.
        if (last_reply_valid_) {
            controller_.empty_mailbox(in_sm_);
            (void)controller_.fill_mailbox(in_sm_, last_reply_);
        }
        controller_.acknowledge_repeat(in_sm_);
    }
    deliver();
    take(now);
    while (count_ > 0 && due_ <= now && !reply_waiting_) {
        answer(state, now);
        deliver();
        take(now);
    }
}

void CoeServer::take(Instant now) noexcept {
    const auto message = controller_.full_mailbox(out_sm_);
    if (message.empty() || count_ == queue_.size()) return;
    const auto parsed = parse_mailbox(message);
    // A counter seen twice in a row is a repetition of a request that was already taken (0 is never checked).
    const bool repeated = parsed && parsed->header.counter != 0 && parsed->header.counter == last_counter_;
    if (!repeated) {
        if (parsed) last_counter_ = parsed->header.counter;
        Slot& slot = queue_[(head_ + count_) % queue_.size()];
        slot.size = std::min(message.size(), slot.bytes.size());
        std::copy_n(message.begin(), slot.size, slot.bytes.begin());
        if (count_++ == 0) due_ = now + response_delay_;
    }
    controller_.empty_mailbox(out_sm_);
}

void CoeServer::answer(EsmState state, Instant now) noexcept {
    const Slot& slot = queue_[head_];
    const std::span<const std::byte> bytes{slot.bytes.data(), slot.size};
    const std::span<std::byte> out{reply_};
    const auto payload_out = out.subspan(mailbox_header_size);
    MailboxType type = MailboxType::error;
    std::size_t size = 0;
    const auto error = [&](MailboxErrorDetail detail) {
        if (payload_out.size() < mailbox_error_size) return;
        encode_mailbox_error(payload_out.first<mailbox_error_size>(), detail);
        type = MailboxType::error;
        size = mailbox_error_size;
    };

    const auto message = parse_mailbox(bytes);
    if (!message) {
        error(MailboxErrorDetail::invalid_size);
    } else if (message->header.type != MailboxType::coe || !description_.mailbox || !description_.mailbox->coe) {
        error(message->header.type == MailboxType::error ? MailboxErrorDetail::invalid_header : MailboxErrorDetail::unsupported_protocol);
    } else if (message->payload.size() < coe_header_size) {
        error(MailboxErrorDetail::size_too_short);
    } else if (coe_service(message->payload) != CoeService::sdo_request) {
        error(MailboxErrorDetail::service_not_supported);
    } else if (message->payload.size() < sdo_segment_header_size + sdo_segment_minimum) {
        error(MailboxErrorDetail::size_too_short);
    } else {
        type = MailboxType::coe;
        size = sdo_.serve(message->payload, payload_out, state, now);
    }

    head_ = (head_ + 1) % queue_.size();
    due_ = --count_ > 0 ? now + response_delay_ : never;
    if (size == 0) return;  // an abort from the client needs no answer
    counter_ = next_mailbox_counter(counter_);
    reply_waiting_ = finish_mailbox(out, type, counter_, size);
}

void CoeServer::deliver() noexcept {
    if (!reply_waiting_ || !controller_.fill_mailbox(in_sm_, reply_)) return;
    reply_waiting_ = false;
    last_reply_ = reply_;
    last_reply_valid_ = true;
}

}  // namespace taktwerk::ecat::sim
