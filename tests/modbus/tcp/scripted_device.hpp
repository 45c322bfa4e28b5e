#pragma once
// A Modbus device for tests of what asks it: registers by number, every request in a log, and whatever fault the test wants.

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "modbus/tcp/exchange.hpp"

namespace taktwerk::modbus::tcp::testing {

class ScriptedDevice final : public Exchange {
public:
    bool connected() const override { return connected_; }
    Fault connect() override {
        log.push_back("connect");
        answered_ = 0;
        connected_ = !connecting;
        return connecting;
    }
    void close() override {
        if (std::exchange(connected_, false)) log.push_back("close");
    }
    Fault read(Table table, std::uint16_t address, std::span<std::uint16_t> values) override {
        log.push_back("read " + text(table, address, values.size()));
        if (const auto fault = fault_at(table, address)) return fault;
        if (had_enough()) return {Fault::Kind::closed};
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = registers[{table, static_cast<std::uint16_t>(address + i)}];
        return {};
    }
    Fault write(Table table, std::uint16_t address, std::span<const std::uint16_t> values) override {
        log.push_back("write " + text(table, address, values.size()));
        if (const auto fault = fault_at(table, address)) return fault;
        if (had_enough()) return {Fault::Kind::closed};
        for (std::size_t i = 0; i < values.size(); ++i) registers[{table, static_cast<std::uint16_t>(address + i)}] = values[i];
        return {};
    }

    using Place = std::pair<Table, std::uint16_t>;
    std::map<Place, std::uint16_t> registers;
    std::vector<std::string> log;
    Fault connecting{}, answering{};    ///< of every attempt from now on
    std::map<Place, Fault> refused_at;  ///< of requests that begin there

    std::size_t answers_before_closing = 0;  ///< in each connection; 0: it never ends one

private:
    bool had_enough() { return answers_before_closing != 0 && answered_++ >= answers_before_closing; }
    Fault fault_at(Table table, std::uint16_t address) const {
        if (answering) return answering;
        const auto found = refused_at.find({table, address});
        return found == refused_at.end() ? Fault{} : found->second;
    }
    static std::string text(Table table, unsigned address, std::size_t count) {
        static constexpr const char* names[] = {"coil", "discrete", "holding", "input"};
        return std::string(names[static_cast<std::size_t>(table)]) + " " + std::to_string(address) + "+" + std::to_string(count);
    }
    bool connected_ = false;
    std::size_t answered_ = 0;
};

}  // namespace taktwerk::modbus::tcp::testing
