#pragma once
// What the tests of the simulated slaves hold in their hand: a network and single datagrams, no master.

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <vector>

#include "core/bytes.hpp"
#include "ecat/sim/sim_network.hpp"
#include "ecat/wire/frame.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat::sim {

using namespace std::chrono_literals;
using Bytes = std::vector<std::byte>;

inline Bytes bytes(std::initializer_list<int> values) {
    Bytes out;
    for (int v : values) out.push_back(static_cast<std::byte>(v));
    return out;
}

template <class T>
Bytes le(T value) {
    Bytes out(sizeof(T));
    store_le<T>(out, 0, value);
    return out;
}

/// What the model was told, in order; tests that care about objects read the dictionary.
class RecordingModel : public DeviceModel {
public:
    void power_on(ObjectDictionary& dictionary, Instant) override { powered_with = &dictionary; }
    void power_off(Instant) override { ++power_offs; }
    std::uint16_t refuse(EsmState, EsmState to, const SyncSettings& settings) override {
        last_settings = settings;
        return to == refused ? refusal : std::uint16_t{0};
    }
    void entered(EsmState state, Instant) override { states.push_back(state); }
    void exchange(Instant now) override { exchanges.push_back(now); }
    void advance(Instant now) override { advanced = std::max(advanced, now); }
    void outputs_lost(Instant now) override { lost.push_back(now); }
    std::uint32_t refuse_write(std::uint16_t index, std::uint8_t, std::int64_t) override {
        return index == refused_object ? refused_code : 0;
    }
    void written(std::uint16_t index, std::uint8_t sub, Instant) override { writes.push_back((std::uint32_t{index} << 8) | sub); }

    ObjectDictionary* powered_with = nullptr;
    std::vector<EsmState> states;
    std::vector<Instant> exchanges, lost;
    std::vector<std::uint32_t> writes;
    SyncSettings last_settings;
    Instant advanced{};
    EsmState refused{};
    std::uint16_t refusal = 0, refused_object = 0;
    std::uint32_t refused_code = 0;
    int power_offs = 0;
};

/// A drive-like slave with the mailboxes of the SV33-E (manual 6.2.6.2) and a small dictionary.
inline DeviceDescription small_drive() {
    DeviceDescription d;
    d.name = "small-drive";
    d.device_name = "SMALL-DRIVE";
    d.identity = {0x000007FB, 0x000C0108, 0x00010001, 77};
    d.mailbox = MailboxDescription{};
    d.sync_managers = {{SmUse::mailbox_out, 0x1000, 0x80, 0x26},
                       {SmUse::mailbox_in, 0x1400, 0x80, 0x22},
                       {SmUse::outputs, 0x1800, 0, 0x64},
                       {SmUse::inputs, 0x1C00, 0, 0x20}};
    d.rx_pdos = {{0x1600, false, {{0x6040, 0, 16}, {0x607A, 0, 32}}}, {0x1701, true, {{0x6040, 0, 16}, {0x607A, 0, 32}, {0x6060, 0, 8}}}};
    d.tx_pdos = {{0x1A00, false, {{0x6041, 0, 16}, {0x6064, 0, 32}}}};
    d.rx_assigned = {0x1600};
    d.tx_assigned = {0x1A00};
    d.rx_rules = d.tx_rules = {1, 4, 12};
    const auto object = [&](std::uint16_t index, std::uint8_t sub, DataType type, Access access, Mappable mappable,
                            std::int64_t value = 0) {
        ObjectEntry e;
        e.index = index, e.sub = sub, e.type = type, e.access = access, e.mappable = mappable, e.value = value;
        d.objects.push_back(e);
        return &d.objects.back();
    };
    object(0x1000, 0, DataType::U32, Access::ro, Mappable::no, 0x00020192);
    object(0x6040, 0, DataType::U16, Access::rw, Mappable::rx);
    object(0x6041, 0, DataType::U16, Access::ro, Mappable::tx, 0x0250);
    object(0x6060, 0, DataType::I8, Access::rw, Mappable::rx);
    object(0x6064, 0, DataType::I32, Access::ro, Mappable::tx);
    object(0x607A, 0, DataType::I32, Access::rw, Mappable::rx);
    object(0x6081, 0, DataType::U32, Access::rw, Mappable::no);
    object(0x6098, 0, DataType::I8, Access::rw, Mappable::no)->maximum = 35;
    d.objects.back().minimum = -2;
    object(0x60F0, 0, DataType::I64, Access::rw, Mappable::no);
    object(0x2000, 1, DataType::U16, Access::wo, Mappable::no);
    object(0x2001, 0, DataType::STRING, Access::rw, Mappable::no);
    return d;
}

class BusProbe {
public:
    struct Answer {
        std::uint16_t wkc = 0;
        Bytes data;
        std::uint16_t adp = 0, irq = 0;
    };

    explicit BusProbe(Instant start = Instant{} + 1s) : network(start), now(start) {}

    SimSlave& add(DeviceDescription description, std::unique_ptr<DeviceModel> model, SlaveOptions options = {}) {
        return network.add(std::make_shared<const DeviceDescription>(std::move(description)), std::move(model), std::move(options));
    }
    /// A small drive with a RecordingModel.
    SimSlave& add_drive(SlaveOptions options = {}, DeviceDescription description = small_drive()) {
        auto model = std::make_unique<RecordingModel>();
        recorders.push_back(model.get());
        return add(std::move(description), std::move(model), std::move(options));
    }

    Answer send(Command command, Address address, Bytes data) {
        std::array<std::byte, max_frame_size> buffer{};
        FrameBuilder builder{buffer, MacAddress{0x00, 1, 2, 3, 4, 5}};
        const auto area = builder.add(command, 1, address, data.size());
        std::copy(data.begin(), data.end(), area.begin());
        const std::size_t size = builder.finish().size();
        const std::span<std::byte> frame{buffer.data(), size};
        flight = network.process(frame, now);
        source_mac_first = buffer[6];
        if (!flight) return {};
        FrameReader reader{frame};
        const auto datagram = reader.next();
        if (!datagram) return {};
        return {datagram->working_counter(), Bytes(datagram->data.begin(), datagram->data.end()), datagram->address.adp(), datagram->irq};
    }
    Answer read(std::uint16_t position, std::uint16_t ado, std::size_t size) {
        return send(Command::APRD, Address::position(position, ado), Bytes(size));
    }
    Answer write(std::uint16_t position, std::uint16_t ado, Bytes data) {
        return send(Command::APWR, Address::position(position, ado), std::move(data));
    }
    template <class T>
    T value(std::uint16_t position, std::uint16_t ado) {
        return load_le<T>(read(position, ado, sizeof(T)).data);
    }
    void wait(Duration time) {
        now += time;
        network.advance(now);
    }

    void set_sync_manager(std::uint16_t position, unsigned n, std::uint16_t start, std::uint16_t length, std::uint8_t control,
                          std::uint8_t activate = 1) {
        Bytes registers(SyncManager::size);
        SyncManager sm;
        sm.start = start, sm.length = length, sm.control = control, sm.activate = activate;
        encode(sm, std::span<std::byte, SyncManager::size>{registers.data(), SyncManager::size});
        write(position, reg::sync_manager_at(n), registers);
    }
    void set_fmmu(std::uint16_t position, unsigned n, const Fmmu& fmmu) {
        Bytes registers(Fmmu::size);
        encode(fmmu, std::span<std::byte, Fmmu::size>{registers.data(), Fmmu::size});
        write(position, reg::fmmu_at(n), registers);
    }
    /// AL control, then long enough for the transition. Returns AL status.
    std::uint16_t request(std::uint16_t position, std::uint16_t al_control) {
        write(position, reg::al_control, le<std::uint16_t>(al_control));
        wait(1ms);
        return value<std::uint16_t>(position, reg::al_status);
    }
    std::uint16_t code(std::uint16_t position) { return value<std::uint16_t>(position, reg::al_status_code); }

    void mailboxes(std::uint16_t position) {
        set_sync_manager(position, 0, 0x1000, 0x80, 0x26);
        set_sync_manager(position, 1, 0x1400, 0x80, 0x22);
    }
    void process_managers(std::uint16_t position, std::uint16_t outputs = 6, std::uint16_t inputs = 6) {
        set_sync_manager(position, 2, 0x1800, outputs, 0x64, outputs > 0);
        set_sync_manager(position, 3, 0x1C00, inputs, 0x20, inputs > 0);
    }
    void to_preop(std::uint16_t position) {
        mailboxes(position);
        request(position, 2);
    }
    void to_safeop(std::uint16_t position) {
        to_preop(position);
        process_managers(position);
        request(position, 4);
    }
    /// The whole request mailbox (as a master must write it), then the answer without mailbox header; empty: none in time.
    Bytes coe(std::uint16_t position, Bytes payload, std::uint8_t mailbox_type = 3, Duration timeout = 5ms) {
        counter = static_cast<std::uint8_t>(counter >= 7 ? 1 : counter + 1);
        Bytes message(0x80);
        store_le<std::uint16_t>(message, 0, static_cast<std::uint16_t>(payload.size()));
        message[5] = static_cast<std::byte>(mailbox_type | (counter << 4));
        std::copy(payload.begin(), payload.end(), message.begin() + 6);
        last_write_wkc = write(position, 0x1000, message).wkc;
        wait(timeout);
        const auto answer = read(position, 0x1400, 0x80);
        if (answer.wkc == 0) return {};
        header.assign(answer.data.begin(), answer.data.begin() + 6);
        const std::size_t length = load_le<std::uint16_t>(answer.data);
        return Bytes(answer.data.begin() + 6, answer.data.begin() + 6 + static_cast<std::ptrdiff_t>(length));
    }
    /// Expedited download; 0, or the abort code.
    std::uint32_t download(std::uint16_t position, std::uint16_t index, std::uint8_t sub, std::size_t size, std::uint32_t value) {
        Bytes request = bytes({0x00, 0x20, static_cast<int>(0x23 | ((4 - size) << 2)), index & 0xFF, index >> 8, sub, 0, 0, 0, 0});
        store_le<std::uint32_t>(request, 6, value);
        const auto answer = coe(position, request);
        if (answer.size() < 10) return 0xFFFF'FFFF;
        return answer[2] == std::byte{0x80} ? load_le<std::uint32_t>(answer, 6) : 0;
    }
    Bytes upload(std::uint16_t position, std::uint16_t index, std::uint8_t sub) {
        return coe(position, bytes({0x00, 0x20, 0x40, index & 0xFF, index >> 8, sub, 0, 0, 0, 0}));
    }

    SimNetwork network;
    Instant now;
    std::vector<RecordingModel*> recorders;
    std::optional<Duration> flight;
    std::byte source_mac_first{};
    std::uint8_t counter = 0;
    std::uint16_t last_write_wkc = 0;
    Bytes header;
};

}  // namespace taktwerk::ecat::sim
