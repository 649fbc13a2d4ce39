#include "sandbox/panels/open_panel.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "sandbox/panels/controls.hpp"

namespace candela::sandbox {

namespace fs = std::filesystem;

namespace {

/// Tab and the arrow keys in the field of the name.
int take_key(ImGuiInputTextCallbackData* data) {
    auto& browser = *static_cast<FolderBrowser*>(data->UserData);
    // Letters may have come in the same frame as the key.
    const std::string typed(data->Buf, static_cast<std::size_t>(data->BufTextLen));
    if (typed != browser.typed()) browser.type(typed);
    if (data->EventFlag == ImGuiInputTextFlags_CallbackCompletion) {
        const std::string completed = browser.completed();
        data->DeleteChars(0, data->BufTextLen);
        data->InsertChars(0, completed.c_str());
    } else {
        browser.mark(data->EventKey == ImGuiKey_UpArrow ? -1 : 1);
    }
    return 0;
}

}  // namespace

void OpenPanel::show(std::vector<SceneList> lists, const fs::path& folder) {
    lists_ = std::move(lists);
    browser_.emplace(folder);
    typed_.clear();
    focuses_ = true;
}

std::optional<fs::path> OpenPanel::draw() {
    if (!browser_) return std::nullopt;
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float unit = ImGui::GetFontSize();
    ImGui::SetNextWindowPos({0.5F * display.x, 0.5F * display.y}, ImGuiCond_Appearing, {0.5F, 0.5F});
    ImGui::SetNextWindowSize({std::min(48.0F * unit, display.x), std::min(32.0F * unit, display.y)},
                             ImGuiCond_Appearing);
    bool stays = true;
    Chosen chosen;
    if (ImGui::Begin("Open a scene", &stays,
                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings)) {
        chosen = draw_name();
        ImGui::BeginChild("lists", {0.3F * ImGui::GetContentRegionAvail().x, 0.0F}, true);
        if (const Chosen listed = draw_lists()) chosen = listed;
        ImGui::EndChild();
        ImGui::SameLine();
        ImGui::BeginChild("folder", {0.0F, 0.0F}, true);
        if (const Chosen found = draw_folder()) chosen = found;
        ImGui::EndChild();
    }
    ImGui::End();
    if (chosen || !stays) hide();
    return chosen;
}

/// A file is chosen; a folder is entered.
OpenPanel::Chosen OpenPanel::pick(const fs::path& path) {
    std::error_code ignored;
    if (path.empty()) return std::nullopt;
    if (!fs::is_directory(path, ignored)) return path;
    browser_->enter(path);
    typed_.clear();
    focuses_ = true;
    return std::nullopt;
}

OpenPanel::Chosen OpenPanel::draw_name() {
    text(browser_->folder().path.string());
    if (std::exchange(focuses_, false)) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-8.0F * ImGui::GetFontSize());
    const FolderEntry* const marked = browser_->marked();
    constexpr ImGuiInputTextFlags flags = ImGuiInputTextFlags_EnterReturnsTrue |
                                          ImGuiInputTextFlags_CallbackCompletion |
                                          ImGuiInputTextFlags_CallbackHistory;
    const bool entered = ImGui::InputText("##file", &typed_, flags, take_key, &*browser_);
    note_control(
        "file name",
        "a .gltf or .glb file, or a sky as .hdr or .exr file. Tab completes the name, the arrow keys "
        "mark one, Return opens it");
    if (typed_ != browser_->typed()) browser_->type(typed_);
    scrolls_ = browser_->marked() != marked;
    ImGui::SameLine();
    const bool pressed = button("open file", "opens the file, or the folder, of this name");
    return entered || pressed ? pick(browser_->picked()) : std::nullopt;
}

OpenPanel::Chosen OpenPanel::draw_lists() const {
    Chosen chosen;
    for (const SceneList& list : lists_) {
        if (list.files.empty()) continue;
        ImGui::TextDisabled("%s", list.heading.c_str());
        for (const fs::path& file : list.files) {
            ImGui::PushID(&file);
            if (ImGui::Selectable(file.filename().string().c_str())) chosen = file;
            note_control(file.filename().string(), file.string().c_str());
            ImGui::PopID();
        }
    }
    return chosen;
}

OpenPanel::Chosen OpenPanel::draw_folder() {
    const std::string& fault = browser_->folder().fault;
    if (!fault.empty()) ImGui::TextColored({1.0F, 0.45F, 0.45F, 1.0F}, "%s", fault.c_str());
    const fs::path folder = browser_->folder().path;
    fs::path clicked;
    if (ImGui::Selectable("../")) clicked = folder.parent_path();
    note_control("../", "the folder around this one");
    const FolderEntry* const marked = browser_->marked();
    for (const FolderEntry& entry : browser_->matches()) {
        const std::string name = entry.name + (entry.is_folder ? "/" : "");
        // A name may have the signs that separate labels from what only identifies them.
        ImGui::PushID(entry.name.c_str());
        if (ImGui::Selectable("##entry", &entry == marked)) clicked = folder / entry.name;
        note_control(name, nullptr);
        if (&entry == marked && scrolls_) ImGui::SetScrollHereY();
        ImGui::SameLine(0.0F, 0.0F);
        text(name);
        ImGui::PopID();
    }
    if (browser_->matches().empty() && fault.empty()) {
        ImGui::TextDisabled("%s", typed_.empty() ? "nothing that can be opened" : "nothing of this name");
    }
    return pick(clicked);
}

}  // namespace candela::sandbox
