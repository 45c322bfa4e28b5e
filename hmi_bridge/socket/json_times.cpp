#include "hmi_bridge/socket/json_times.hpp"

#include "hmi_bridge/message_count.hpp"
#include "hmi_bridge/socket/json_writer.hpp"

namespace taktwerk::hmi {
namespace {

void put_histogram(JsonWriter& json, const SharedHistogram& times) {
    std::uint64_t all = 0;
    json.open("bins", '[');
    for (std::size_t i = 0; i < Histogram::bucket_count; ++i) {
        const auto n = times.bucket(i);
        if (n == 0) continue;
        all += n;
        json.open('[');
        json.value(Histogram::bucket_first(i));
        json.value(Histogram::bucket_last(i));
        json.value(n);
        json.close(']');
    }
    json.close(']');
    const auto longest = times.longest();
    json.field("count", all);
    json.field("longest_ns", count(longest.duration));
    json.field("longest_cycle", longest.cycle);
}

void put_named(JsonWriter& json, std::string_view name, const SharedHistogram& times) {
    json.open('{');
    json.field("name", name);
    put_histogram(json, times);
    json.close('}');
}

}  // namespace

std::string times_json(const runtime::MachineLayout& layout, const runtime::MachineTimes& times) {
    JsonWriter json(16 * 1024);
    json.open('{');
    json.field("cycle_ns", count(layout.cycle));
    json.open("lateness", '{');
    put_histogram(json, times.cycle->lateness);
    json.close('}');
    json.open("compute", '{');
    put_histogram(json, times.cycle->compute);
    json.close('}');
    json.open("steps", '[');
    for (std::size_t i = 0; i < times.cycle->steps.size(); ++i)
        put_named(json, runtime::name(static_cast<runtime::Step>(i)), times.cycle->steps[i]);
    json.close(']');
    json.open("tasks", '[');
    for (std::size_t i = 0; times.tasks != nullptr && i < times.tasks->size() && i < layout.tasks.size(); ++i)
        put_named(json, layout.tasks[i], (*times.tasks)[i]);
    json.close(']');
    json.open("task_lateness", '[');
    for (std::size_t i = 0; times.task_lateness != nullptr && i < times.task_lateness->size() && i < layout.tasks.size(); ++i)
        put_named(json, layout.tasks[i], (*times.task_lateness)[i]);
    json.close(']');
    json.close('}');
    return json.take();
}

}  // namespace taktwerk::hmi
