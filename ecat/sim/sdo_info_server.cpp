#include "ecat/sim/sdo_info_server.hpp"

#include <algorithm>
#include <array>

#include "core/bytes.hpp"
#include "ecat/description/coe_type_number.hpp"
#include "ecat/wire/sdo.hpp"

namespace taktwerk::ecat::sim {

namespace {

constexpr std::size_t longest_description = 1024;  ///< fixed part, three values, name

std::uint16_t access_word(const Entry& entry) noexcept {
    std::uint16_t word = 0;
    if (entry.access() != Access::wo) word = entry_access::read;
    // Mappings and assignments can be written in PREOP only; everything else in every state with a mailbox.
    if (entry.access() != Access::ro)
        word = static_cast<std::uint16_t>(word | (entry.role() == EntryRole::plain ? entry_access::write : entry_access::write_preop));
    if (entry.mappable() == Mappable::rx || entry.mappable() == Mappable::both)
        word = static_cast<std::uint16_t>(word | entry_access::rx_mappable);
    if (entry.mappable() == Mappable::tx || entry.mappable() == Mappable::both)
        word = static_cast<std::uint16_t>(word | entry_access::tx_mappable);
    return word;
}

bool belongs(std::span<const Entry> object, ObjectList list) noexcept {
    const auto any = [&](std::uint16_t bit) {
        return std::any_of(object.begin(), object.end(), [&](const Entry& entry) { return (access_word(entry) & bit) != 0; });
    };
    switch (list) {
        case ObjectList::all: return true;
        case ObjectList::rx_mappable: return any(entry_access::rx_mappable);
        case ObjectList::tx_mappable: return any(entry_access::tx_mappable);
        case ObjectList::backup: return any(entry_access::backup);
        case ObjectList::startup: return any(entry_access::setting);
    }
    return false;
}

}  // namespace

SdoInfoServer::SdoInfoServer(const ObjectDictionary& dictionary)
    : dictionary_(dictionary), data_(std::max(2 + 2 * dictionary.entries().size(), longest_description)) {}

bool SdoInfoServer::accept(std::span<const std::byte> request) noexcept {
    const auto message = parse_sdo_info(request);
    if (!message) return false;
    done_ = 0;
    switch (message->opcode) {
        case SdoInfoOpcode::list_request:
            opcode_ = SdoInfoOpcode::list_response;
            size_ = list(message->data);
            break;
        case SdoInfoOpcode::object_request:
            opcode_ = SdoInfoOpcode::object_response;
            size_ = object(message->data);
            break;
        case SdoInfoOpcode::entry_request:
            opcode_ = SdoInfoOpcode::entry_response;
            size_ = entry(message->data);
            break;
        case SdoInfoOpcode::list_response:
        case SdoInfoOpcode::object_response:
        case SdoInfoOpcode::entry_response:
        case SdoInfoOpcode::error: return false;
    }
    pending_ = true;
    return true;
}

std::size_t SdoInfoServer::next(std::span<std::byte> out) noexcept {
    // Fragments of an object list end at an index, so that each can be read by itself.
    const std::size_t room = (out.size() - std::min(out.size(), sdo_info_header_size)) & ~std::size_t{1};
    if (room == 0) return pending_ = false, 0;
    const std::size_t part = std::min(room, size_ - done_);
    SdoInfoMessage message;
    message.opcode = opcode_;
    message.data = std::span<const std::byte>{data_}.subspan(done_, part);
    done_ += part;
    message.fragments_left = static_cast<std::uint16_t>((size_ - done_ + room - 1) / room);
    message.incomplete = message.fragments_left > 0;
    pending_ = message.incomplete;
    return encode_sdo_info(out, message);
}

std::size_t SdoInfoServer::refuse(std::uint32_t code) noexcept {
    opcode_ = SdoInfoOpcode::error;
    store_le<std::uint32_t>(data_, 0, code);
    return 4;
}

std::size_t SdoInfoServer::list(std::span<const std::byte> question) noexcept {
    if (question.size() < 2) return refuse(sdo_abort::parameter_incompatible);
    const auto wanted = load_le<std::uint16_t>(question);
    constexpr std::uint16_t counts = 0;  // list type 0: how long the five lists are
    if (wanted > static_cast<std::uint16_t>(ObjectList::startup)) return refuse(sdo_abort::value_range);
    std::array<std::uint16_t, 5> lengths{};
    store_le<std::uint16_t>(data_, 0, wanted);
    std::size_t at = 2;
    for (std::size_t first = 0; first < dictionary_.entries().size();) {
        const auto object = dictionary_.object(dictionary_.entries()[first].index());
        first += object.size();
        for (std::size_t n = 1; n <= lengths.size(); ++n)
            if (belongs(object, static_cast<ObjectList>(n))) ++lengths[n - 1];
        if (wanted == counts || !belongs(object, static_cast<ObjectList>(wanted))) continue;
        store_le<std::uint16_t>(data_, at, object.front().index());
        at += 2;
    }
    if (wanted != counts) return at;
    for (const auto length : lengths) {
        store_le<std::uint16_t>(data_, at, length);
        at += 2;
    }
    return at;
}

std::size_t SdoInfoServer::object(std::span<const std::byte> question) noexcept {
    if (question.size() < 2) return refuse(sdo_abort::parameter_incompatible);
    const auto entries = dictionary_.object(load_le<std::uint16_t>(question));
    if (entries.empty()) return refuse(sdo_abort::no_object);
    ObjectDescriptionView view;
    view.index = entries.front().index();
    view.max_sub = entries.back().sub();
    const auto [code, data_type] = dictionary_.shape(view.index);
    view.code = static_cast<std::uint8_t>(code);
    view.data_type = data_type != 0 ? data_type : type_number(entries.back().type());
    view.name = dictionary_.object_name(view.index);
    return encode_object_description(data_, view);
}

std::size_t SdoInfoServer::entry(std::span<const std::byte> question) noexcept {
    if (question.size() < 4) return refuse(sdo_abort::parameter_incompatible);
    const auto index = load_le<std::uint16_t>(question);
    const auto* entry = dictionary_.find(index, static_cast<std::uint8_t>(question[2]));
    if (entry == nullptr) return refuse(dictionary_.has_object(index) ? sdo_abort::no_subindex : sdo_abort::no_object);
    const auto wanted = static_cast<std::uint8_t>(question[3]);

    EntryDescriptionView view;
    view.index = index;
    view.sub = entry->sub();
    view.data_type = type_number(entry->type());
    view.bits = static_cast<std::uint16_t>(entry->bits() != 0 ? entry->bits() : 8 * entry->text().size());
    view.access = access_word(*entry);
    view.name = entry->name();
    std::array<std::array<std::byte, 8>, 3> values{};
    const auto value = [&](std::size_t n, std::uint8_t bit, const std::optional<std::int64_t>& number) -> std::span<const std::byte> {
        if ((wanted & bit) == 0 || !number || entry->bits() == 0) return {};
        store_le<std::int64_t>(values[n], 0, *number);
        view.contains = static_cast<std::uint8_t>(view.contains | bit);
        return std::span<const std::byte>{values[n]}.first(entry->byte_size());
    };
    view.default_value = value(0, value_info::default_value, entry->default_value());
    view.minimum = value(1, value_info::minimum, entry->minimum());
    view.maximum = value(2, value_info::maximum, entry->maximum());
    return encode_entry_description(data_, view);
}

}  // namespace taktwerk::ecat::sim
