#pragma once
// Writes on their way from clients to the machine, and its verdicts on the way back. Two threads beside the cycle: the server's, and the one that
// hands commands to the machine. Bounded: a client has one order at a time.

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/time.hpp"
#include "modbus/server/answer.hpp"

namespace taktwerk::modbus::server {

/// One write request of one client.
struct WriteOrder {
    std::uint64_t id = 0;          ///< of all orders, from 1
    std::uint64_t connection = 0;  ///< from 1; never the same again
    std::string who;               ///< "192.168.1.7:50112"
    Instant at{};                  ///< when it had come
    std::vector<RegisterChange> changes;
};

struct WriteVerdict {
    std::uint64_t order = 0;
    Exception exception = Exception::none;  ///< none: carried out
};

class OrderBook {
public:
    // --- thread of the server ---------------------------------------------------------------------------------------------------------
    void place(WriteOrder order) {
        const std::lock_guard lock{mutex_};
        orders_.push_back(std::move(order));
    }
    /// That client is gone: what it has set is let go.
    void leave(std::uint64_t connection) {
        const std::lock_guard lock{mutex_};
        gone_.push_back(connection);
    }
    [[nodiscard]] std::optional<WriteVerdict> next_verdict() { return next(verdicts_); }

    // --- thread of the machine's side ---------------------------------------------------------------------------------------------------
    [[nodiscard]] std::optional<WriteOrder> next_order() { return next(orders_); }
    [[nodiscard]] std::optional<std::uint64_t> next_gone() { return next(gone_); }
    void judge(const WriteVerdict& verdict) {
        const std::lock_guard lock{mutex_};
        verdicts_.push_back(verdict);
    }

private:
    template <class T>
    std::optional<T> next(std::deque<T>& queue) {
        const std::lock_guard lock{mutex_};
        if (queue.empty()) return std::nullopt;
        std::optional<T> first{std::move(queue.front())};
        queue.pop_front();
        return first;
    }

    std::mutex mutex_;
    std::deque<WriteOrder> orders_;
    std::deque<std::uint64_t> gone_;
    std::deque<WriteVerdict> verdicts_;
};

}  // namespace taktwerk::modbus::server
