#include "runtime/replay/stand_ins.hpp"

namespace taktwerk::runtime {

class StandIns::Line final : public modbus::SerialLine {
public:
    explicit Line(const modbus::LineSettings& settings) : settings_(settings) {}
    [[nodiscard]] const modbus::LineSettings& settings() const noexcept override { return settings_; }
    bool send(std::span<const std::byte>, Instant) override { return false; }
    std::size_t receive(std::span<std::byte>, Instant) override { return 0; }
    void discard(Instant) override {}
    [[nodiscard]] bool present() const noexcept override { return false; }

private:
    modbus::LineSettings settings_;
};

class StandIns::Device final : public modbus::tcp::Exchange {
public:
    [[nodiscard]] bool connected() const override { return false; }
    [[nodiscard]] modbus::tcp::Fault connect() override { return nobody; }
    void close() override {}
    [[nodiscard]] modbus::tcp::Fault read(modbus::tcp::Table, std::uint16_t, std::span<std::uint16_t>) override { return nobody; }
    [[nodiscard]] modbus::tcp::Fault write(modbus::tcp::Table, std::uint16_t, std::span<const std::uint16_t>) override { return nobody; }

private:
    static constexpr modbus::tcp::Fault nobody{modbus::tcp::Fault::Kind::unreachable, 0};
};

StandIns::StandIns(const MachineConfig& config) {
    for (const auto& line : config.serial) lines_.push_back(std::make_unique<Line>(line.settings));
    for (std::size_t i = 0; i < config.modbus.size(); ++i) devices_.push_back(std::make_unique<Device>());
}

std::vector<modbus::SerialLine*> StandIns::lines() const {
    std::vector<modbus::SerialLine*> out;
    for (const auto& line : lines_) out.push_back(line.get());
    return out;
}

std::vector<modbus::tcp::Exchange*> StandIns::exchanges() const {
    std::vector<modbus::tcp::Exchange*> out;
    for (const auto& device : devices_) out.push_back(device.get());
    return out;
}

}  // namespace taktwerk::runtime
