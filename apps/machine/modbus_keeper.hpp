#pragma once
// The thread of the Modbus TCP server: what clients send, or do not, holds up nobody else (docs/stopping.md).

#include <atomic>
#include <chrono>
#include <thread>

#include "core/clock.hpp"
#include "modbus/server/server.hpp"

namespace taktwerk::apps {

class ModbusKeeper {
public:
    static constexpr Duration look = std::chrono::milliseconds{20};  ///< at most so long it takes until the thread has ended

    /// Both outlive this. nullptr: no thread.
    ModbusKeeper(modbus::server::Server* server, Clock& clock) {
        if (server != nullptr)
            thread_ = std::thread{[this, server, &clock] {
                while (!ended_.load(std::memory_order_acquire)) {
                    server->wait(look);
                    server->step(clock.now());
                }
            }};
    }
    ~ModbusKeeper() {
        ended_.store(true, std::memory_order_release);
        if (thread_.joinable()) thread_.join();
    }
    ModbusKeeper(const ModbusKeeper&) = delete;
    ModbusKeeper& operator=(const ModbusKeeper&) = delete;

private:
    std::atomic<bool> ended_{false};
    std::thread thread_;
};

}  // namespace taktwerk::apps
