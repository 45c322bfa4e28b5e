#pragma once
// A slave that is only a mailbox, and answers what a test put into it: for the SDO client and its fuzz target.

#include <algorithm>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "ecat/transport/loopback.hpp"
#include "ecat/wire/mailbox.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat::test {

class ScriptedMailbox : public FrameSink {
public:
    using Bytes = std::vector<std::byte>;
    static constexpr std::uint16_t out_start = 0x1000, in_start = 0x1400, box_size = 0x80;

    bool full = false;  ///< takes no request

    void advance(Instant) noexcept override {}
    std::optional<Duration> process(std::span<std::byte> frame, Instant) noexcept override {
        FrameEditor editor{frame};
        while (auto datagram = editor.next()) {
            const std::uint16_t ado = datagram->address.ado();
            bool taken = true;
            if (datagram->command == Command::FPWR && ado == out_start) {
                taken = !full;
                if (taken) request(datagram->data);
            } else if (datagram->command == Command::FPRD && ado == reg::sync_manager_at(1) + sm_status_offset) {
                datagram->data[0] = static_cast<std::byte>(outbox_.empty() ? 0 : SyncManager::mailbox_full);
            } else if (datagram->command == Command::FPRD && ado == in_start) {
                taken = !outbox_.empty();
                if (taken) {
                    const auto& answer = outbox_.front();
                    std::copy_n(answer.begin(), std::min(answer.size(), datagram->data.size()), datagram->data.begin());
                    outbox_.pop_front();
                }
            }
            if (taken) datagram->wkc[0] = std::byte{1};
        }
        return std::chrono::microseconds{1};
    }

protected:
    /// A request has come; what it is answered with goes into put_out().
    virtual void request(std::span<const std::byte> mailbox) = 0;
    /// The messages wait one behind the other, each `box_size` long.
    void put_out(Bytes message) { outbox_.push_back(std::move(message)); }

private:
    std::deque<Bytes> outbox_;
};

}  // namespace taktwerk::ecat::test
