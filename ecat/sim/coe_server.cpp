#include "ecat/sim/coe_server.hpp"

#include <algorithm>

#include "core/bytes.hpp"
#include "ecat/wire/mailbox.hpp"
#include "ecat/wire/sdo.hpp"

namespace taktwerk::ecat::sim {

namespace {

unsigned position_of(const DeviceDescription& description, SmUse use, unsigned otherwise) {
    for (std::size_t n = 0; n < description.sync_managers.size(); ++n)
        if (description.sync_managers[n].use == use) return static_cast<unsigned>(n);
    return otherwise;
}

BootstrapDescription boot_of(const DeviceDescription& description) {
    return description.mailbox && description.mailbox->bootstrap ? *description.mailbox->bootstrap : BootstrapDescription{};
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
      info_(dictionary),
      boxes_{position_of(description, SmUse::mailbox_out, 0), position_of(description, SmUse::mailbox_in, 1), mailbox_header_size},
      response_delay_(response_delay),
      queue_(std::max<std::size_t>(1, description.mailbox ? description.mailbox->max_pending : 1),
             std::max<std::size_t>({mailbox_header_size, size_of(description, out_sm()), boot_of(description).out_size})) {
    reply_.resize(std::max<std::size_t>({mailbox_header_size, size_of(description, in_sm()), boot_of(description).in_size}));
    unasked_.resize(reply_.size());
    current_.resize(reply_.size());
    read_.resize(reply_.size());
}

void CoeServer::start(EsmState state) noexcept {
    const bool boot = state == EsmState::boot;
    const std::size_t out = boot ? boot_of(description_).out_size : size_of(description_, out_sm());
    boxes_.in_size = std::max<std::size_t>(mailbox_header_size, boot ? boot_of(description_).in_size : size_of(description_, in_sm()));
    services_.start(std::max(mailbox_header_size, out) - mailbox_header_size, boxes_.in_size - mailbox_header_size);
    queue_.clear();
    reply_waiting_ = displaced_ = read_valid_ = false;
    in_box_ = InBox::nothing;
    last_counter_ = counter_ = 0;
    due_ = never;
    running_ = true;
    sdo_.reset();
    info_.reset();
    emergencies_.clear();
}

void CoeServer::stop() noexcept {
    running_ = false;
    due_ = never;
}

Instant CoeServer::next_event() const noexcept { return running_ && !stuck_ && !reply_waiting_ && !more_pending() ? due_ : never; }

void CoeServer::step(EsmState state, Instant now) noexcept {
    if (!running_ || stuck_) return;
    follow_mailbox();
    deliver();
    take(now);
    while (queue_.size() > 0 && due_ <= now && !reply_waiting_ && !more_pending()) {
        answer(state, now);
        deliver();
        take(now);
    }
}

void CoeServer::take(Instant now) noexcept {
    const auto message = controller_.full_mailbox(boxes_.out_sm);
    if (message.empty() || queue_.full()) return;
    const auto parsed = parse_mailbox(message);
    // A counter seen twice in a row is a repetition of a request that was already taken (0 is never checked).
    const bool repeated = parsed && parsed->header.counter != 0 && parsed->header.counter == last_counter_;
    if (!repeated) {
        if (parsed) last_counter_ = parsed->header.counter;
        if (queue_.size() == 0) due_ = now + response_delay_;
        queue_.push(message);
    }
    controller_.empty_mailbox(boxes_.out_sm);
}

void CoeServer::answer(EsmState state, Instant now) noexcept {
    const std::span<std::byte> out = std::span{reply_}.first(boxes_.in_size);
    MailboxType type = MailboxType::error;
    const std::size_t size = serve(queue_.front(), out.subspan(mailbox_header_size), type, state, now);
    queue_.pop();
    due_ = queue_.size() > 0 ? now + response_delay_ : never;
    if (size == 0) return;  // an abort from the client needs no answer
    counter_ = next_mailbox_counter(counter_);
    reply_waiting_ = finish_mailbox(out, type, counter_, size);
    if (wrong_lengths_ == 0) return;
    const std::array lies{out.size() - mailbox_header_size + 1, std::size_t{0}, size - 1};
    store_le<std::uint16_t>(out, 0, static_cast<std::uint16_t>(lies[wrong_lengths_-- % lies.size()]));
}

std::size_t CoeServer::serve(std::span<const std::byte> bytes, std::span<std::byte> out, MailboxType& type, EsmState state,
                             Instant now) noexcept {
    const auto error = [&](MailboxErrorDetail detail) -> std::size_t {
        if (out.size() < mailbox_error_size) return 0;
        encode_mailbox_error(out.first<mailbox_error_size>(), detail);
        type = MailboxType::error;
        return mailbox_error_size;
    };
    const auto message = parse_mailbox(bytes);
    if (!message) return error(MailboxErrorDetail::invalid_size);
    if (message->header.type == MailboxType::error) return error(MailboxErrorDetail::invalid_header);
    if (state == EsmState::boot && message->header.type != MailboxType::foe) return error(MailboxErrorDetail::unsupported_protocol);
    if (MailboxService* other = services_.find(message->header.type)) {
        type = message->header.type;
        return other->serve(message->payload, out, state, now);
    }
    if (message->header.type != MailboxType::coe || !description_.mailbox || !description_.mailbox->coe)
        return error(MailboxErrorDetail::unsupported_protocol);
    const auto service = coe_service(message->payload);
    if (!service) return error(MailboxErrorDetail::size_too_short);
    if (*service == CoeService::sdo_request) {
        if (message->payload.size() < sdo_segment_header_size + sdo_segment_minimum) return error(MailboxErrorDetail::size_too_short);
        type = MailboxType::coe;
        return sdo_.serve(message->payload, out, state, now);
    }
    if (*service == CoeService::sdo_info && description_.mailbox->sdo_info) {
        if (message->payload.size() < sdo_info_header_size) return error(MailboxErrorDetail::size_too_short);
        if (!info_.accept(message->payload)) return error(MailboxErrorDetail::service_not_supported);
        type = MailboxType::coe;
        return info_.next(out);
    }
    return error(MailboxErrorDetail::service_not_supported);
}

void CoeServer::send(const Emergency& emergency) noexcept {
    if (!running_ || emergencies_.full()) return;
    emergencies_.push(emergency);
    if (stuck_) return;
    follow_mailbox();
    deliver();
}

void CoeServer::follow_mailbox() noexcept {
    if (in_box_ != InBox::nothing && controller_.full_mailbox(boxes_.in_sm).empty()) {
        if (in_box_ == InBox::current) std::swap(read_, current_), read_valid_ = true;
        in_box_ = InBox::nothing;
    }
    if (controller_.repeat_requested(boxes_.in_sm)) {
        if (read_valid_) {
            displaced_ = displaced_ || in_box_ == InBox::current;
            controller_.empty_mailbox(boxes_.in_sm);
            if (controller_.fill_mailbox(boxes_.in_sm, std::span{read_}.first(boxes_.in_size))) in_box_ = InBox::repetition;
        }
        controller_.acknowledge_repeat(boxes_.in_sm);
    }
    if (displaced_ && in_box_ == InBox::nothing && controller_.fill_mailbox(boxes_.in_sm, std::span{current_}.first(boxes_.in_size))) {
        displaced_ = false;
        in_box_ = InBox::current;
    }
}

bool CoeServer::put(std::span<const std::byte> message) noexcept {
    if (in_box_ != InBox::nothing || displaced_ || !controller_.fill_mailbox(boxes_.in_sm, message)) return false;
    std::copy(message.begin(), message.end(), current_.begin());
    in_box_ = InBox::current;
    return true;
}

void CoeServer::deliver() noexcept {
    if (!emergencies_.empty()) {
        // A counter is spent only on what really goes out: the mailbox may still be full.
        const std::span<std::byte> out = std::span{unasked_}.first(boxes_.in_size);
        const std::size_t size = encode_emergency(out.subspan(mailbox_header_size), emergencies_.front());
        const std::uint8_t counter = next_mailbox_counter(counter_);
        if (size == 0 || !finish_mailbox(out, MailboxType::coe, counter, size) || !put(out)) return;
        counter_ = counter;
        emergencies_.pop();
        return;
    }
    if (!reply_waiting_ && more_pending()) fetch_more();
    if (reply_waiting_ && put(std::span{reply_}.first(boxes_.in_size))) reply_waiting_ = false;
}

void CoeServer::fetch_more() noexcept {
    const std::span<std::byte> out = std::span{reply_}.first(boxes_.in_size);
    const bool objects = info_.pending();
    const std::size_t size =
        objects ? info_.next(out.subspan(mailbox_header_size)) : services_.ethernet->next(out.subspan(mailbox_header_size));
    counter_ = next_mailbox_counter(counter_);
    reply_waiting_ = size > 0 && finish_mailbox(out, objects ? MailboxType::coe : MailboxType::eoe, counter_, size);
}

}  // namespace taktwerk::ecat::sim
