// The verbs of the command line: one file each, registered in main.cpp.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace seedframe {

/// A verb hands over what to do when the user named it: a function that returns the exit code.
using OnSelected = std::function<void(std::function<int()>)>;

void add_submit_verb(CLI::App& app, const OnSelected& on_selected);
void add_resume_verb(CLI::App& app, const OnSelected& on_selected);
void add_run_batch_verb(CLI::App& app, const OnSelected& on_selected);
void add_stream_verb(CLI::App& app, const OnSelected& on_selected);
void add_status_verb(CLI::App& app, const OnSelected& on_selected);
void add_render_verb(CLI::App& app, const OnSelected& on_selected);
void add_show_verb(CLI::App& app, const OnSelected& on_selected);
void add_preview_verb(CLI::App& app, const OnSelected& on_selected);
void add_verify_error_verb(CLI::App& app, const OnSelected& on_selected);
void add_explain_verb(CLI::App& app, const OnSelected& on_selected);
void add_export_verb(CLI::App& app, const OnSelected& on_selected);
void add_check_verb(CLI::App& app, const OnSelected& on_selected);
void add_asset_verb(CLI::App& app, const OnSelected& on_selected);
void add_audit_verb(CLI::App& app, const OnSelected& on_selected);
void add_bench_verb(CLI::App& app, const OnSelected& on_selected);
void add_compare_verb(CLI::App& app, const OnSelected& on_selected);
void add_doctor_verb(CLI::App& app, const OnSelected& on_selected);
void add_report_verb(CLI::App& app, const OnSelected& on_selected);
void add_serve_verb(CLI::App& app, const OnSelected& on_selected);
void add_manual_verb(CLI::App& app, const OnSelected& on_selected);

}  // namespace seedframe
