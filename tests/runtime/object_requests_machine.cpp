// Programs read and write objects of a slave while the machine runs: through the mailbox, beside the process data.

#include "fb_library/all_blocks.hpp"
#include "programs/api/object_future.hpp"
#include "runtime/tasks/object_requests.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using fb::EC_SdoRead;
using fb::EC_SdoWrite;

/// Reads 6041h once, writes 609Ah (U32), reads it back, asks for an object that does not exist.
class Parametrise final : public Program {
public:
    DeviceRef drive;
    EC_SdoRead status, back, missing;
    EC_SdoWrite velocity;
    std::int64_t status_word = 0, read_back = 0, abort = 0;
    bool finished = false;

    void declare(Declaration& d) override {
        drive = d.device("x_drive");
        d.monitor("status_word", status_word);
        d.monitor("read_back", read_back);
        d.monitor("abort", abort);
        d.monitor("finished", finished);
        d.task<&Parametrise::scan>("main");
    }
    void scan(TaskContext& ctx) {
        status.Device = velocity.Device = back.Device = missing.Device = drive;
        status.Index = 0x6041;
        status.Execute = true;
        status(ctx);
        velocity.Index = 0x609A;
        velocity.Value = 123456;
        velocity.Size = 4;
        velocity.Execute = status.Done;
        velocity(ctx);
        back.Index = 0x609A;
        back.Execute = velocity.Done;
        back(ctx);
        missing.Index = 0x5FFF;
        missing.Execute = back.Done;
        missing(ctx);
        status_word = status.Value;
        read_back = back.Value;
        abort = missing.AbortCode;
        finished = missing.Error && missing.ErrorID == axes::ErrorId::object_refused;
    }
};

TEST(ObjectRequests, AProgramReadsAndWritesObjectsWhileProcessDataGoesOn) {
    TestMachine m{with_program(2, &entry_of<Parametrise>)};
    ASSERT_TRUE(m.up());

    const auto before = m.machine->bus().statistics();
    bool fresh = true;
    m.on_cycle = [&] {
        for (std::size_t s = 0; s < 3; ++s) fresh = fresh && m.machine->bus().health(s).fresh;
    };
    ASSERT_TRUE(m.until([&] { return variable(m, "finished") != 0; }, 2s)) << m.alarms();

    EXPECT_EQ(variable(m, "read_back"), 123456);
    EXPECT_EQ(static_cast<std::uint32_t>(variable(m, "abort")), 0x06020000u) << "ETG.1000.6: object does not exist";
    EXPECT_NE(variable(m, "status_word"), 0) << "statusword of a drive with main power: at least voltage enabled (bit 4)";
    EXPECT_TRUE(fresh) << "process data missed a cycle";
    EXPECT_EQ(m.machine->bus().statistics().working_counter_errors, before.working_counter_errors);
}

/// The same from a task at a divisor, and longer than eight bytes: the device name as a string.
class Name final : public Program {
public:
    DeviceRef drive;
    ObjectFuture name;
    bool asked = false;
    std::int64_t length = 0, first_letter = 0;
    void declare(Declaration& d) override {
        drive = d.device("x_drive");
        d.monitor("length", length);
        d.monitor("first_letter", first_letter);
        d.task<&Name::scan>("main");
    }
    void scan(TaskContext& ctx) {
        if (!asked) name.read(ctx, drive, 0x1008, 0);
        asked = true;
        const ObjectAnswer answer = name.answer(ctx);
        if (answer.outcome != ObjectOutcome::done) return;
        length = static_cast<std::int64_t>(answer.data.size());
        first_letter = answer.data.empty() ? 0 : static_cast<std::int64_t>(answer.data[0]);
    }
};

TEST(ObjectRequests, ASlowerTaskReadsAStringOfTheDevice) {
    TestMachine m{with_program(1, &entry_of<Name>, 8)};
    ASSERT_TRUE(m.up());
    const std::string name = servo_device()->device_name;
    ASSERT_FALSE(name.empty());
    EXPECT_TRUE(m.until([&] { return variable(m, "length") != 0; }, 2s));
    EXPECT_EQ(variable(m, "length"), static_cast<double>(name.size()));
    EXPECT_EQ(variable(m, "first_letter"), static_cast<double>(name[0]));
}

/// Asks for more than there are places, and counts what it was told.
class Greedy final : public Program {
public:
    DeviceRef drive;
    std::array<ObjectFuture, ObjectRequests::places_per_program + 2> futures;
    bool asked = false;
    std::int64_t answered = 0, refused = 0;
    void declare(Declaration& d) override {
        drive = d.device("x_drive");
        d.monitor("answered", answered);
        d.monitor("refused", refused);
        d.task<&Greedy::scan>("main");
    }
    void start() override { asked = false; }
    void scan(TaskContext& ctx) {
        if (!asked)
            for (auto& future : futures) future.read(ctx, drive, 0x6041, 0);
        asked = true;
        answered = refused = 0;
        for (const auto& future : futures) {
            const auto outcome = future.answer(ctx).outcome;
            answered += outcome == ObjectOutcome::done ? 1 : 0;
            refused += outcome == ObjectOutcome::no_place ? 1 : 0;
        }
    }
};

TEST(ObjectRequests, APlaceThatIsTakenIsSaidSoAndTheOthersAreAnswered) {
    TestMachine m{with_program(1, &entry_of<Greedy>)};
    ASSERT_TRUE(m.up());
    EXPECT_TRUE(m.until([&] { return variable(m, "answered") == ObjectRequests::places_per_program; }, 5s));
    EXPECT_EQ(variable(m, "refused"), 2);
}

TEST(ObjectRequests, AProgramThatStartsAnewHasAllItsPlacesAgain) {
    TestMachine m{with_program(1, &entry_of<Greedy>)};
    ASSERT_TRUE(m.up());
    m.run(3ms);  // asked, hardly answered
    OperatorCommand stop;
    stop.action = OperatorAction::program_stop;
    stop.index = 0;
    m.command(stop);
    m.run(20ms);
    OperatorCommand start = stop;
    start.action = OperatorAction::program_start;
    EXPECT_EQ(m.command(start).answer, Answer::accepted);
    EXPECT_TRUE(m.until([&] { return variable(m, "answered") == ObjectRequests::places_per_program; }, 5s));
}

TEST(ObjectRequests, ASlaveWithoutPowerGivesNoAnswer) {
    class Ask final : public Program {
    public:
        DeviceRef drive;
        EC_SdoRead read;
        std::int64_t error = 0;
        void declare(Declaration& d) override {
            drive = d.device("x_drive");
            d.monitor("error", error);
            d.task<&Ask::scan>("main");
        }
        void scan(TaskContext& ctx) {  // again and again
            read.Device = drive;
            read.Index = 0x6041;
            read.Execute = !read.Done && !read.Error;
            read(ctx);
            if (read.Error) error = static_cast<std::int64_t>(read.ErrorID);
        }
    };
    TestMachine m{with_program(1, &entry_of<Ask>)};
    ASSERT_TRUE(m.up());
    m.run(100ms);
    EXPECT_EQ(variable(m, "error"), 0);
    m.world.set_slave_power("x_drive", false);
    EXPECT_TRUE(m.until([&] { return variable(m, "error") != 0; }, 10s));
    EXPECT_EQ(variable(m, "error"), static_cast<double>(axes::ErrorId::object_no_answer));
}

TEST(ObjectRequests, AnUnknownDeviceIsAnErrorOfTheMachineAndNamesTheNearest) {
    class Wrong final : public Program {
    public:
        void declare(Declaration& d) override {
            (void)d.device("x_drvie");
            d.task<&Wrong::scan>("main");
        }
        void scan(TaskContext&) {}
    };
    const auto config = with_program(1, &entry_of<Wrong>);
    World world{config, Instant{} + 1s};
    auto built = Machine::build(config, world.transport());
    auto* errors = std::get_if<1>(&built);
    ASSERT_NE(errors, nullptr);
    ASSERT_EQ(errors->size(), 1u);
    EXPECT_EQ(errors->front().code, "program.unknown_device");
    EXPECT_NE(errors->front().text().find("did you mean 'x_drive'"), std::string::npos) << errors->front().text();
}

}  // namespace
}  // namespace taktwerk::runtime::testing
