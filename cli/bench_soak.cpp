// SPDX-License-Identifier: Apache-2.0
#include "bench_soak.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <thread>

#include "bench/client.hpp"
#include "bench/rubbish.hpp"
#include "output_folder.hpp"
#include "report.hpp"
#include "samples.hpp"
#include "server/serve.hpp"

namespace cli {

namespace {

using namespace resect;
using Json = nlohmann::ordered_json;

constexpr int rounds = 5, clients = 50;
constexpr double seconds = 3; // of each half of a round

/// A driving page that takes its frames; its statuses say how fast the simulation steps.
class Page {
public:
    explicit Page(int port) : client_(port) {
        client_.upgrade();
        client_.read_until("scene");
    }

    void set_speed(double speed) { client_.send_text(Json{{"id", 1}, {"speed", speed}}.dump()); }

    /// Steps a second over `seconds`; 0 where the server is gone.
    double measure_step_rate() {
        const std::int64_t first = read_step();
        std::int64_t last = first;
        double passed = 0;
        for (Timer timer; passed < seconds && last >= 0; passed += timer.lap()) {
            last = read_step();
        }
        return first < 0 || last < 0 ? 0 : static_cast<double>(last - first) / passed;
    }

private:
    std::int64_t read_step() {
        const nlohmann::json status = client_.read_until("status");
        return status.is_object() ? status["step"].get<std::int64_t>() : -1;
    }

    bench::Client client_;
};

/// At one speed: 1 is what a page asks for, the most is more than a large body can do.
Json measure(Page& page, int port, const std::string& body, double speed, bool talk) {
    page.set_speed(speed);
    page.measure_step_rate();
    Samples alone, besieged, ratio;
    std::int64_t connections = 0;
    for (int round = 0; round < rounds; ++round) {
        alone.add(page.measure_step_rate());
        bench::RubbishClients rubbish(port, clients);
        besieged.add(page.measure_step_rate());
        connections += rubbish.connections();
        ratio.add(besieged.last() / alone.last());
    }
    if (talk) {
        fmt::print(
            "soak  {:<12} at {} times real time: {:6.0f} steps/s alone, {:6.0f} beside {} clients that "
            "made {} connections; ratio {:.2f} ({:.2f} to {:.2f})\n",
            body, speed, alone.percentile(0.5), besieged.percentile(0.5), clients, connections,
            ratio.percentile(0.5), ratio.percentile(0), ratio.percentile(1));
    }
    return {{"body", body},
            {"speed", speed},
            {"step_rate_alone", alone.percentile(0.5)},
            {"step_rate_with_clients", besieged.percentile(0.5)},
            {"clients", clients},
            {"connections", connections},
            {"ratio", {{"median", ratio.percentile(0.5)}, {"least", ratio.percentile(0)}}}};
}

/// A liver that the most speed is too much for, as a file in `folder`.
Result<server::SceneEntry> write_large_scene(const std::string& folder) {
    const std::string path = folder + "/large_liver.json";
    const Json scene = {{"name", "Large liver"},
                        {"tissue",
                         {{"mesh", {{"liver", {{"elements", 60000}}}}},
                          {"materials", {{{"young", 20000}, {"poisson", 0.4}, {"density", 1000}}}},
                          {"damping", 2},
                          {"fixed", {{{"box", {{"lo", {-1, -1, -1}}, {"hi", {-0.04, 1, 1}}}}}}}}}};
    const Result<void> written = write_text(path, scene.dump());
    if (!written) { return written.error(); }
    return server::SceneEntry{"large_liver", "Large liver", {}, path};
}

} // namespace

Result<Json> bench_soak(bool talk) {
    std::error_code missing;
    const std::string folder = (std::filesystem::temp_directory_path(missing) / "resect_soak").string();
    if (missing) { return Error{"soak: there is no folder for temporary files; set TMPDIR to one"}; }
    if (const Result<void> made = make_folder(folder); !made) { return made.error(); }
    const Result<server::SceneEntry> scene = write_large_scene(folder);
    if (!scene) { return scene.error(); }
    const Result<std::unique_ptr<server::Server>> server = server::Server::open(
        {.network = {.port = 0}, .theatre = {.first = *scene, .threads = 1, .folder = folder}}, {});
    if (!server) { return server.error(); }
    std::thread io([&] { (*server)->run(); });
    Json rows = Json::array();
    {
        Page page((*server)->port());
        for (const double speed : {0.1, 4.0}) {
            rows.push_back(measure(page, (*server)->port(), "liver 60000", speed, talk));
        }
    }
    (*server)->stop();
    io.join();
    return rows;
}

} // namespace cli
