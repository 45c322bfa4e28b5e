#include "modbus/server/answer.hpp"

#include <cmath>

namespace taktwerk::modbus::server {

namespace {

/// Puts a frame together; its length is known at the end.
class FrameWriter {
public:
    explicit FrameWriter(const AnswerTo& to, std::uint8_t function) noexcept {
        word(to.transaction);
        word(0);
        word(0);
        byte(to.unit);
        byte(function);
    }
    void byte(std::uint8_t value) noexcept { frame_.bytes[frame_.size++] = value; }
    void word(std::uint16_t value) noexcept {
        byte(static_cast<std::uint8_t>(value >> 8));
        byte(static_cast<std::uint8_t>(value & 0xFF));
    }
    void zeros(std::size_t count) noexcept { frame_.size += count; }
    std::uint8_t& at(std::size_t place) noexcept { return frame_.bytes[place]; }
    [[nodiscard]] std::size_t size() const noexcept { return frame_.size; }
    [[nodiscard]] AnswerFrame frame() noexcept {
        const auto length = frame_.size - (header_bytes - 1);
        frame_.bytes[4] = static_cast<std::uint8_t>(length >> 8);
        frame_.bytes[5] = static_cast<std::uint8_t>(length & 0xFF);
        return frame_;
    }

private:
    AnswerFrame frame_;
};

}  // namespace

AnswerFrame refusal(const AnswerTo& to, Exception exception) noexcept {
    FrameWriter out{to, static_cast<std::uint8_t>(to.function | 0x80)};
    out.byte(static_cast<std::uint8_t>(exception));
    return out.frame();
}

ReadAnswer answer_read(const RegisterMap& map, const ServedImage& image, const AnswerTo& to, const Request& request) noexcept {
    const auto places = map.find(request.table, request.address, request.count);
    if (!places) return {Exception::illegal_address, refusal(to, Exception::illegal_address)};
    const bool bits = is_bits(request.table);
    const std::size_t bytes = bits ? (request.count + 7u) / 8u : request.count * 2u;
    FrameWriter out{to, request.function};
    out.byte(static_cast<std::uint8_t>(bytes));
    const auto begin = out.size();
    out.zeros(bytes);
    for (const auto& place : *places) {
        const auto& words = image.words[place.index];
        const std::size_t offset = place.address - request.address;
        if (bits) {
            if (words[0] != 0) out.at(begin + offset / 8) = static_cast<std::uint8_t>(out.at(begin + offset / 8) | 1u << (offset % 8));
            continue;
        }
        for (std::size_t i = 0; i < addresses_of(map.registers()[place.index].type); ++i) {  // bits may share a register
            auto& high = out.at(begin + 2 * (offset + i));
            auto& low = out.at(begin + 2 * (offset + i) + 1);
            high = static_cast<std::uint8_t>(high | words[i] >> 8);
            low = static_cast<std::uint8_t>(low | (words[i] & 0xFF));
        }
    }
    return {Exception::none, out.frame()};
}

AnswerFrame written(const AnswerTo& to, const Request& request) noexcept {
    FrameWriter out{to, request.function};
    out.word(request.address);
    const bool single = request.function == 5 || request.function == 6;
    out.word(single ? request.word(0) : request.count);
    return out.frame();
}

AskedChanges changes_of(const RegisterMap& map, const Request& request) {
    AskedChanges out;
    const auto places = map.find(request.table, request.address, request.count);
    if (!places) return {Exception::illegal_address, {}};
    for (const auto& place : *places) {
        const auto& one = map.registers()[place.index];
        if (!one.writable) return {Exception::illegal_address, {}};
        const std::size_t offset = place.address - request.address;
        RegisterWords words{};
        if (is_bits(request.table)) words[0] = request.bit(offset) ? 1 : 0;
        else
            for (std::size_t i = 0; i < addresses_of(one.type); ++i) words[i] = request.word(offset + i);
        const double number = number_of(one, words);
        if (!std::isfinite(number)) return {Exception::illegal_value, {}};
        out.changes.push_back({place.index, number});
    }
    return out;
}

}  // namespace taktwerk::modbus::server
