#include "ecat/sim/sdo_server.hpp"

#include <algorithm>
#include <bit>

#include "core/bytes.hpp"
#include "ecat/sim/pdo_rules.hpp"

namespace taktwerk::ecat::sim {

SdoServer::SdoServer(const DeviceDescription& description, ObjectDictionary& dictionary, DeviceModel& model)
    : description_(description), dictionary_(dictionary), model_(model), value_(largest_value) {}

void SdoServer::reset() noexcept { transfer_ = Transfer::none; }

std::size_t SdoServer::serve(std::span<const std::byte> request, std::span<std::byte> out, EsmState state, Instant now) noexcept {
    const auto message = parse_sdo(request);
    if (!message) return abort(out, 0, 0, sdo_abort::unknown_command);
    switch (message->kind) {
        case SdoKind::upload_request: return upload(*message, out);
        case SdoKind::upload_segment_request: return upload_segment(*message, out);
        case SdoKind::download_request:
            return download(*message, (request[coe_header_size] & std::byte{1}) != std::byte{0}, out, state, now);
        case SdoKind::download_segment_request: return download_segment(*message, out, state, now);
        case SdoKind::abort: reset(); return 0;
        case SdoKind::download_response:
        case SdoKind::download_segment_response:
        case SdoKind::upload_response:
        case SdoKind::upload_segment_response: break;
    }
    return abort(out, message->index, message->sub, sdo_abort::unknown_command);
}

std::size_t SdoServer::abort(std::span<std::byte> out, std::uint16_t index, std::uint8_t sub, std::uint32_t code) noexcept {
    reset();
    return encode_sdo_abort(out, index, sub, code);
}

void SdoServer::abort_object(std::uint16_t index, std::uint8_t sub, std::uint32_t code) {
    std::erase_if(refused_, [&](const Refused& refused) { return refused.index == index && refused.sub == sub; });
    if (code != 0) refused_.push_back({index, sub, code});
}

std::uint32_t SdoServer::locate(std::uint16_t index, std::uint8_t sub, Entry*& entry) noexcept {
    for (const auto& refused : refused_)
        if (refused.index == index && refused.sub == sub) return refused.code;
    entry = dictionary_.find(index, sub);
    if (entry != nullptr) return 0;
    return dictionary_.has_object(index) ? sdo_abort::no_subindex : sdo_abort::no_object;
}

std::span<const std::byte> SdoServer::value_of(const Entry& entry) noexcept {
    if (entry.type() == DataType::STRING) {
        const std::size_t size = std::min(entry.text().size(), value_.size());
        std::transform(entry.text().begin(), entry.text().begin() + static_cast<std::ptrdiff_t>(size), value_.begin(),
                       [](char c) { return static_cast<std::byte>(c); });
        return {value_.data(), size};
    }
    store_le<std::int64_t>(value_, 0, entry.get());
    return {value_.data(), entry.byte_size()};
}

std::size_t SdoServer::upload(const SdoMessage& request, std::span<std::byte> out) noexcept {
    reset();
    std::span<const std::byte> value;
    if (request.complete_access) {
        if (const auto code = collect(request.index, request.sub, value); code != 0) return abort(out, request.index, request.sub, code);
    } else {
        Entry* entry = nullptr;
        if (const auto code = locate(request.index, request.sub, entry); code != 0) return abort(out, request.index, request.sub, code);
        if (entry->access() == Access::wo) return abort(out, request.index, request.sub, sdo_abort::write_only);
        value = value_of(*entry);
    }
    const std::size_t size = encode_upload_response(out, request.index, request.sub, value, request.complete_access);
    const std::size_t carried = value.size() <= 4 && !value.empty() ? value.size() : size - std::min(size, sdo_initiate_size);
    if (carried < value.size()) {
        transfer_ = Transfer::upload;
        index_ = request.index;
        sub_ = request.sub;
        toggle_ = false;
        done_ = carried;
        total_ = value.size();
    }
    return size;
}

std::size_t SdoServer::upload_segment(const SdoMessage& request, std::span<std::byte> out) noexcept {
    if (transfer_ != Transfer::upload) return abort(out, 0, 0, sdo_abort::unknown_command);
    if (request.toggle != toggle_) return abort(out, index_, sub_, sdo_abort::toggle);
    const std::size_t part = std::min(total_ - done_, out.size() - std::min(out.size(), sdo_segment_header_size));
    const bool last = done_ + part == total_;
    const auto segment = std::span<const std::byte>{value_}.subspan(done_, part);
    const std::size_t size = encode_upload_segment_response(out, toggle_ && toggles_, last, segment);
    done_ += part;
    toggle_ = !toggle_;
    if (last) reset();
    return size;
}

std::size_t SdoServer::download(const SdoMessage& request, bool size_given, std::span<std::byte> out, EsmState state,
                                Instant now) noexcept {
    Entry* entry = nullptr;
    auto data = request.data;
    reset();
    complete_ = request.complete_access;
    const auto refuse = [&](std::uint32_t code) { return abort(out, request.index, request.sub, code); };
    if (complete_) {
        if (const auto code = refuse_complete(request.index, request.sub); code != 0) return refuse(code);
    } else {
        if (const auto code = locate(request.index, request.sub, entry); code != 0) return refuse(code);
        if (entry->access() == Access::ro) return refuse(sdo_abort::read_only);
    }
    if (!request.expedited && request.complete_size > request.data.size()) {
        if (request.complete_size > value_.size()) return refuse(sdo_abort::out_of_memory);
        transfer_ = Transfer::download;
        index_ = request.index;
        sub_ = request.sub;
        toggle_ = false;
        std::copy(request.data.begin(), request.data.end(), value_.begin());
        done_ = request.data.size();
        total_ = request.complete_size;
    } else if (complete_) {
        if (const auto code = store_complete(request.index, request.sub, data, state, now); code != 0) return refuse(code);
    } else {
        // Expedited without a size: four bytes came, the object's own size counts.
        if (request.expedited && !size_given) data = data.first(std::min(data.size(), entry->byte_size()));
        if (const auto code = store(*entry, data, state, now); code != 0) return refuse(code);
    }
    return encode_download_response(out, request.index, request.sub, complete_);
}

std::size_t SdoServer::download_segment(const SdoMessage& request, std::span<std::byte> out, EsmState state, Instant now) noexcept {
    if (transfer_ != Transfer::download) return abort(out, 0, 0, sdo_abort::unknown_command);
    if (request.toggle != toggle_) return abort(out, index_, sub_, sdo_abort::toggle);
    if (done_ + request.data.size() > total_) return abort(out, index_, sub_, sdo_abort::too_long);
    std::copy(request.data.begin(), request.data.end(), value_.begin() + static_cast<std::ptrdiff_t>(done_));
    done_ += request.data.size();
    if (request.last) {
        if (done_ < total_) return abort(out, index_, sub_, sdo_abort::too_short);
        std::uint32_t code = 0;
        if (complete_) {
            code = store_complete(index_, sub_, {value_.data(), total_}, state, now);
        } else {
            Entry* entry = nullptr;
            code = locate(index_, sub_, entry);
            if (code == 0) code = store(*entry, {value_.data(), total_}, state, now);
        }
        if (code != 0) return abort(out, index_, sub_, code);
        reset();
    }
    const bool toggle = toggle_;
    toggle_ = !toggle_;
    return encode_download_segment_response(out, toggle);
}

std::uint32_t SdoServer::store(Entry& entry, std::span<const std::byte> data, EsmState state, Instant now) noexcept {
    if (entry.type() == DataType::STRING) {
        if (const auto code = model_.refuse_write(entry.index(), entry.sub(), 0); code != 0) return code;
        std::string text(data.size(), '\0');
        std::transform(data.begin(), data.end(), text.begin(), [](std::byte b) { return static_cast<char>(b); });
        entry.set_text(std::move(text));
        model_.written(entry.index(), entry.sub(), now);
        return 0;
    }
    if (data.size() > entry.byte_size()) return sdo_abort::too_long;
    if (data.size() < entry.byte_size()) return sdo_abort::too_short;
    std::uint64_t raw = 0;
    for (std::size_t i = 0; i < data.size(); ++i) raw |= static_cast<std::uint64_t>(data[i]) << (8 * i);
    std::int64_t value = std::bit_cast<std::int64_t>(raw);
    if (entry.is_signed() && entry.bits() < 64) {
        const unsigned drop = 64u - entry.bits();
        value = std::bit_cast<std::int64_t>(raw << drop) >> drop;
    }
    return store_value(entry, value, state, now);
}

std::uint32_t SdoServer::store_value(Entry& entry, std::int64_t value, EsmState state, Instant now) noexcept {
    if (entry.type() == DataType::BOOL && value > 1) return sdo_abort::value_too_high;
    if (entry.maximum() && value > *entry.maximum()) return sdo_abort::value_too_high;
    if (entry.minimum() && value < *entry.minimum()) return sdo_abort::value_too_low;
    if (const auto code = refuse_pdo_write(description_, dictionary_, entry, value, state); code != 0) return code;
    if (const auto code = model_.refuse_write(entry.index(), entry.sub(), value); code != 0) return code;
    entry.set(value);
    model_.written(entry.index(), entry.sub(), now);
    return 0;
}

}  // namespace taktwerk::ecat::sim
