#include "ecat/sim/plain_device.hpp"

#include <algorithm>

#include "ecat/sim/process_data.hpp"

namespace taktwerk::ecat::sim {

PlainDevice::PlainDevice(const DeviceDescription& description) : has_dictionary_(description.mailbox && description.mailbox->coe) {
    const auto is_signed_object = [&](const PdoEntry& entry) {
        return std::any_of(description.objects.begin(), description.objects.end(), [&](const ObjectEntry& object) {
            return object.index == entry.index && object.sub == entry.sub && is_signed(object.type);
        });
    };
    const auto add = [&](const PdoEntry& entry, bool output, std::uint32_t bit) {
        if (entry.index != 0 && find(entry.index, entry.sub) == nullptr)
            objects_.push_back({entry.index, entry.sub, output, {bit, entry.bits, is_signed_object(entry)}, nullptr, 0});
    };
    for (const bool output : {true, false}) {
        const auto& pdos = output ? description.rx_pdos : description.tx_pdos;
        const auto& assigned = output ? description.rx_assigned : description.tx_assigned;
        std::uint32_t bit = 0;  // the sync managers of a direction lie in a row, each as whole bytes
        for (unsigned n = 0; n < description.sync_managers.size(); ++n) {
            for (const auto index : assigned)
                for (const auto& pdo : pdos) {
                    if (pdo.index != index || !belongs_to(description, pdo, n)) continue;
                    for (const auto& entry : pdo.entries) {
                        add(entry, output, bit);
                        bit += entry.bits;
                    }
                }
            bit = (bit + 7) / 8 * 8;
        }
        if (has_dictionary_)  // the master may assign the others
            for (const auto& pdo : pdos)
                for (const auto& entry : pdo.entries) add(entry, output, 0);
    }
}

const PlainDevice::Object* PlainDevice::find(std::uint16_t index, std::uint8_t sub) const noexcept {
    for (const auto& object : objects_)
        if (object.index == index && object.sub == sub) return &object;
    return nullptr;
}

void PlainDevice::set(std::uint16_t index, std::uint8_t sub, std::int64_t value) noexcept {
    for (auto& object : objects_)
        if (object.index == index && object.sub == sub && !object.output) object.value = value;
}

std::int64_t PlainDevice::get(std::uint16_t index, std::uint8_t sub) const noexcept {
    const auto* object = find(index, sub);
    return object ? object->value : 0;
}

void PlainDevice::power_on(ObjectDictionary& dictionary, Instant) {
    clear_outputs();
    if (has_dictionary_)
        for (auto& object : objects_) object.entry = dictionary.find(object.index, object.sub);
}

void PlainDevice::exchange(Instant) {
    for (auto& object : objects_) {
        if (object.entry == nullptr) continue;
        if (object.output) object.value = object.entry->get();
        else object.entry->set(object.value);
    }
}

void PlainDevice::clear_outputs() noexcept {
    for (auto& object : objects_) {
        if (!object.output) continue;
        object.value = 0;
        if (object.entry != nullptr) object.entry->set(0);
    }
}

void PlainDevice::raw_outputs(std::span<const std::byte> outputs) {
    for (auto& object : objects_)
        if (object.output && (object.signal.bit_offset + object.signal.bits + 7) / 8 <= outputs.size())
            object.value = read_signal(outputs, object.signal);
}

void PlainDevice::raw_inputs(std::span<std::byte> inputs) {
    for (const auto& object : objects_)
        if (!object.output && (object.signal.bit_offset + object.signal.bits + 7) / 8 <= inputs.size())
            write_signal(inputs, object.signal, object.value);
}

}  // namespace taktwerk::ecat::sim
