#include "axes/sim/state_display.hpp"

#include "axes/sim/set_if_there.hpp"

namespace taktwerk::axes::sim {

void StateDisplay::power_on(ecat::sim::ObjectDictionary& dictionary) {
    const auto find = [&](ParameterAddress at) { return at.index ? dictionary.find(at.index, at.sub) : nullptr; };
    state_ = find(objects_.state);
    code_ = find(objects_.error_code);
    sub_code_ = find(objects_.error_sub_code);
    next_entry_ = find(objects_.history_next);
    record_entries_.clear();
    for (std::size_t i = 0; i < records_.size(); ++i)
        record_entries_.push_back(find({objects_.history.index, static_cast<std::uint8_t>(objects_.history.sub + i)}));
    show_records();
}

void StateDisplay::show(bool powered, std::uint16_t code, std::uint32_t detail) noexcept {
    auto value = powered ? objects_.enabled : objects_.free;
    for (const auto& row : objects_.alarms)
        if (code != 0 && row.code == code) value = row.value;
    set_if_there(state_, value);
    set_if_there(code_, code);
    set_if_there(sub_code_, code == communication_code_ ? detail : 0);
}

void StateDisplay::remember(std::uint16_t code) noexcept {
    if (records_.empty()) return;
    records_[next_] = code;
    next_ = (next_ + 1) % records_.size();
    show_records();
}

void StateDisplay::show_records() noexcept {
    set_if_there(next_entry_, records_.empty() ? 0 : static_cast<std::int64_t>(next_) + 1);
    for (std::size_t i = 0; i < record_entries_.size(); ++i) set_if_there(record_entries_[i], records_[i]);
}

}  // namespace taktwerk::axes::sim
