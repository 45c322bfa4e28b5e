#include "ecat/eoe/ethernet_link.hpp"

#include <utility>

#include "ecat/eoe/frame_cutter.hpp"

namespace taktwerk::ecat {

namespace {

/// A slave whose mailbox is full may wait until its own frames are fetched: so it is asked for them in between.
constexpr Duration piece_patience = std::chrono::milliseconds{10};
constexpr int piece_attempts = 200;

}  // namespace

EthernetLink::EthernetLink(MailboxEndpoint& mailbox, std::function<void(std::span<const std::byte>)> received)
    : mailbox_(mailbox), received_(std::move(received)) {
    mailbox_.ethernet = [this](std::span<const std::byte> payload) {
        const auto fragment = parse_eoe_fragment(payload);
        if (!fragment) return;
        const auto frame = assembly_.take(*fragment);
        if (!frame) return;
        ++counts_.received;
        received_(*frame);
    };
}

void EthernetLink::send(std::span<const std::byte> frame) {
    if (queue_.size() >= queue_limit) {
        ++counts_.dropped_full;
        return;
    }
    queue_.emplace_back(frame.begin(), frame.end());
}

Script<Result<void>> EthernetLink::carry(DatagramPort& port) {
    for (;;) {
        const Result<void> read = co_await read_unasked(port, mailbox_);
        if (!read) co_return read;
        if (queue_.empty()) {
            co_await pause(ethernet_poll_period);
            continue;
        }
        std::vector<std::byte> frame = std::move(queue_.front());
        queue_.pop_front();
        const Result<void> sent = co_await send_frame(port, std::move(frame));
        if (!sent) co_return sent;
    }
}

Script<Result<void>> EthernetLink::send_frame(DatagramPort& port, std::vector<std::byte> frame) {
    FrameCutter cutter{frame, mailbox_.out_size, number_};
    if (!cutter.possible()) {
        ++counts_.dropped_size;
        co_return Result<void>{};
    }
    number_ = static_cast<std::uint8_t>((number_ + 1) & 0xF);
    while (const auto fragment = cutter.next()) {
        std::vector<std::byte> piece(eoe_header_size + fragment->data.size());
        (void)encode_eoe_fragment(piece, *fragment);
        const Result<void> sent = co_await send_piece(port, std::move(piece));
        if (!sent &&
            sent.error().code == "bus.no_frame") {  // one that was lost costs this frame; one after the other is seen when it is asked
            ++counts_.dropped_lost;
            co_return Result<void>{};
        }
        if (!sent) co_return sent;
    }
    ++counts_.sent;
    co_return Result<void>{};
}

Script<Result<void>> EthernetLink::send_piece(DatagramPort& port, std::vector<std::byte> piece) {
    MailboxRequest request;
    request.about = "sending an Ethernet frame";
    request.payload = std::move(piece);
    request.type = MailboxType::eoe;
    request.patience = piece_patience;
    Result<void> told;
    for (int attempt = 0; attempt < piece_attempts; ++attempt) {
        {
            co_await mailbox_.lock.acquire();
            const ScriptLockGuard guard{mailbox_.lock};
            told = co_await tell(port, mailbox_, request);
        }
        if (told || told.error().code != "eoe.mailbox") co_return told;
        const Result<void> read = co_await read_unasked(port, mailbox_);
        if (!read) co_return read;
    }
    co_return told;
}

}  // namespace taktwerk::ecat
