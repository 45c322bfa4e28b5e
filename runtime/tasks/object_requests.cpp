#include "runtime/tasks/object_requests.hpp"

#include <algorithm>

#include "ecat/coe/sdo_client.hpp"
#include "runtime/recording/inbox_record.hpp"

namespace taktwerk::runtime {

class ObjectRequests::OfProgram final : public ObjectAccess {
public:
    enum class State : std::uint8_t { free, filling, asked, working, arrived, answered, abandoned };

    struct Place {
        std::atomic<State> state{State::free};
        std::atomic<std::uint32_t> generation{0};
        DeviceRef device;
        std::uint16_t index = 0;
        std::uint8_t sub = 0;
        bool write = false;
        std::array<std::byte, object_data_limit> data{};
        std::size_t size = 0;
        ObjectOutcome outcome = ObjectOutcome::pending;
        std::uint32_t abort_code = 0;
        ecat::SdoTicket ticket = 0;  ///< service side

        bool move(State from, State to) noexcept { return state.compare_exchange_strong(from, to, std::memory_order_acq_rel); }

        void take(const Result<ecat::SdoResult>& result) {
            abort_code = 0;
            if (!write) size = 0;
            if (!result) {
                abort_code = ecat::abort_code(result.error());
                outcome = abort_code != 0 ? ObjectOutcome::refused : ObjectOutcome::no_answer;
            } else if (result->data.size() > data.size()) {
                outcome = ObjectOutcome::too_long;
            } else {
                outcome = ObjectOutcome::done;
                if (write) return;
                std::copy(result->data.begin(), result->data.end(), data.begin());
                size = result->data.size();
            }
        }
    };

    explicit OfProgram(std::size_t devices) : devices_(devices) {}

    ObjectTicket read(DeviceRef device, std::uint16_t index, std::uint8_t sub) noexcept override {
        return ask(device, index, sub, {}, false);
    }
    ObjectTicket write(DeviceRef device, std::uint16_t index, std::uint8_t sub, std::span<const std::byte> data) noexcept override {
        return data.empty() || data.size() > object_data_limit ? ObjectTicket{} : ask(device, index, sub, data, true);
    }
    [[nodiscard]] ObjectOutcome why(DeviceRef device, std::size_t size) const noexcept override {
        if (device.index >= devices_) return ObjectOutcome::invalid_device;
        if (size > object_data_limit) return ObjectOutcome::too_long;
        return held() < places_per_program && !closed_.load(std::memory_order_relaxed) ? ObjectOutcome::pending : ObjectOutcome::no_place;
    }
    [[nodiscard]] ObjectAnswer answer(ObjectTicket ticket) const noexcept override {
        ObjectAnswer result;
        if (!names_request(ticket)) return result;
        const Place& place = places_[ticket.place];
        if (place.state.load(std::memory_order_acquire) != State::answered) {
            result.outcome = ObjectOutcome::pending;
            return result;
        }
        result.outcome = place.outcome;
        result.abort_code = place.abort_code;
        if (!place.write) result.data = std::span<const std::byte>{place.data}.first(place.size);
        return result;
    }
    void release(ObjectTicket ticket) noexcept override {
        if (names_request(ticket)) free(places_[ticket.place]);
    }

    // --- for the owner ------------------------------------------------------------------------------------------------------
    void open() noexcept {
        for (Place& place : places_) free(place);
        closed_.store(false, std::memory_order_relaxed);
    }
    void close() noexcept { closed_.store(true, std::memory_order_relaxed); }
    template <class Visit>
    void each(Visit visit) {
        for (std::size_t i = 0; i < places_.size(); ++i) visit(i, places_[i]);
    }

private:
    [[nodiscard]] std::size_t held() const noexcept {
        return static_cast<std::size_t>(std::count_if(places_.begin(), places_.end(), [](const Place& place) {
            const State state = place.state.load(std::memory_order_relaxed);
            return state != State::free && state != State::abandoned;
        }));
    }
    [[nodiscard]] bool names_request(ObjectTicket ticket) const noexcept {
        return ticket.valid() && ticket.place < places_.size() &&
               places_[ticket.place].generation.load(std::memory_order_acquire) == ticket.generation;
    }

    ObjectTicket ask(DeviceRef device, std::uint16_t index, std::uint8_t sub, std::span<const std::byte> data, bool write) noexcept {
        if (device.index >= devices_ || held() >= places_per_program || closed_.load(std::memory_order_relaxed)) return {};
        for (std::size_t i = 0; i < places_.size(); ++i) {
            Place& place = places_[i];
            if (!place.move(State::free, State::filling)) continue;
            std::uint32_t generation = place.generation.load(std::memory_order_relaxed) + 1;
            if (generation == 0) generation = 1;
            place.device = device;
            place.index = index;
            place.sub = sub;
            place.write = write;
            std::copy(data.begin(), data.end(), place.data.begin());
            place.size = data.size();
            place.outcome = ObjectOutcome::pending;
            place.generation.store(generation, std::memory_order_release);
            place.state.store(State::asked, std::memory_order_release);
            return {static_cast<std::uint16_t>(i), generation};
        }
        return {};
    }

    /// Its ticket names nothing afterwards. Service side and cycle may move the place on meanwhile, so the states are tried in the
    /// order in which a request passes them.
    static void free(Place& place) noexcept {
        const State now = place.state.load(std::memory_order_acquire);
        if (now == State::free || now == State::filling || now == State::abandoned) return;
        place.generation.fetch_add(1, std::memory_order_acq_rel);
        if (place.move(State::asked, State::free)) return;
        if (place.move(State::working, State::abandoned)) return;
        if (place.move(State::arrived, State::free)) return;
        place.move(State::answered, State::free);
    }

    std::size_t devices_;
    std::atomic<bool> closed_{false};
    std::array<Place, places_per_program + at_work> places_{};  // what is abandoned takes no place from the program
};

ObjectRequests::ObjectRequests(std::size_t programs, std::size_t devices) {
    for (std::size_t p = 0; p < programs; ++p) programs_.push_back(std::make_unique<OfProgram>(devices));
}
ObjectRequests::~ObjectRequests() = default;

ObjectAccess& ObjectRequests::of(std::size_t program) noexcept { return *programs_[program]; }

void ObjectRequests::open(std::size_t program) noexcept { programs_[program]->open(); }
void ObjectRequests::close(std::size_t program) noexcept { programs_[program]->close(); }

void ObjectRequests::take_answers(Recorder* recorder, Instant now) noexcept {
    using State = OfProgram::State;
    for (std::size_t p = 0; p < programs_.size(); ++p)
        programs_[p]->each([&](std::size_t i, OfProgram::Place& place) {
            if (place.state.load(std::memory_order_acquire) != State::arrived) return;
            if (recorder != nullptr) {
                const std::span<const std::byte> value = std::span{place.data}.first(place.write ? 0 : place.size);
                record_object(*recorder, now, static_cast<std::uint16_t>(p), static_cast<std::uint16_t>(i), place.outcome, place.abort_code,
                              value);
            }
            place.move(State::arrived, State::answered);
        });
}

void ObjectRequests::step(ecat::Master& bus) {
    using State = OfProgram::State;
    for (auto& program : programs_) {
        std::size_t working = 0;
        program->each([&](std::size_t, const OfProgram::Place& place) {
            const State now = place.state.load(std::memory_order_acquire);
            working += now == State::working || now == State::abandoned ? 1 : 0;
        });
        program->each([&](std::size_t, OfProgram::Place& place) {
            const State now = place.state.load(std::memory_order_acquire);
            if (now == State::asked && working < at_work && place.move(State::asked, State::working)) {
                ++working;
                const auto data = std::span<const std::byte>{place.data}.first(place.size);
                place.ticket = place.write ? bus.download(place.device.index, place.index, place.sub, data)
                                           : bus.upload(place.device.index, place.index, place.sub);
            }
            if (place.state.load(std::memory_order_acquire) != State::working && now != State::abandoned) return;
            const auto result = bus.poll(place.ticket);
            if (!result) return;
            place.take(*result);
            if (!place.move(State::working, State::arrived)) place.state.store(State::free, std::memory_order_release);
        });
    }
}

}  // namespace taktwerk::runtime
