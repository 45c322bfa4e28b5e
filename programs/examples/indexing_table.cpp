// A rotary indexing table: it turns on by one station, always forward, and waits there while the stations work. The table is a modulo
// axis, so station 0 is 0 degrees again after every turn, for ever exactly.

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;

class IndexingTable final : public Program {
    AxisRef table_;
    Input<bool> run_;
    Output<bool> in_place_;
    Parameter stations_, speed_, work_time_;

    MC_Power power_;
    MC_Home home_;
    MC_MoveAbsolute index_;
    TON work_;

    std::int32_t station_ = 0;
    std::int64_t indexed_ = 0;

public:
    void declare(Declaration& d) override {
        table_ = d.axis("table");
        run_ = d.input("run");
        in_place_ = d.output("in_place");
        stations_ = d.parameter("stations", {.value = 8, .minimum = 2, .maximum = 36, .unit = "", .doc = "stations on the table"});
        speed_ = d.parameter("speed", {.value = 180, .minimum = 1, .maximum = 360, .unit = "deg/s", .doc = "while indexing"});
        work_time_ = d.parameter("work_time", {.value = 0.3, .minimum = 0, .maximum = 60, .unit = "s", .doc = "the stations' time"});
        d.monitor("station", station_, "", "station in front of the operator, or on its way there");
        d.monitor("indexed", indexed_, "", "steps since start");
        d.block("home", home_);
        d.block("index", index_);
        d.task<&IndexingTable::scan>("main");
    }

    void scan(TaskContext& ctx) {
        power_.Axis = table_;
        power_.Enable = true;
        power_(ctx);

        home_.Axis = table_;
        home_.Execute = power_.Status && !ctx.view(table_)->homed;
        home_(ctx);

        // The next station is commanded once the stations have had their time. Execute falls with Done, so each step is an edge.
        const bool ready = power_.Status && ctx.view(table_)->homed;
        work_.IN = ready && ctx.get(run_) && !index_.Execute;
        work_.PT = from_seconds(ctx.get(work_time_));
        work_(ctx);
        const auto stations = static_cast<std::int32_t>(ctx.get(stations_));
        if (work_.Q) {
            station_ = (station_ + 1) % stations;
            index_.Execute = true;
        } else if (index_.Done || index_.Error || !ready) {
            index_.Execute = false;
        }
        index_.Axis = table_;
        index_.Position = 360.0 * station_ / stations;
        index_.Direction = mcPositiveDirection;  // never back over the parts that are being worked on
        index_.Velocity = ctx.get(speed_);
        index_(ctx);
        if (index_.Done) ++indexed_;

        ctx.set(in_place_, ready && !index_.Busy && ctx.view(table_)->in_position);
    }
};

}  // namespace

TAKTWERK_PROGRAM(IndexingTable)
