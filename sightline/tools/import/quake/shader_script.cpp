// Shader scripts: words on lines, braces two deep, and tables of what each word means for sight.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/shader_script.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "sightline/tools/scene/one_line.h"

namespace sightline::tools {
namespace {

struct WordRoles {
    std::string_view patterns;  ///< with a blank between each two
    BrushRole role;
};

/// The first row that has a word decides; without one it is not known.
BrushRole roleIn(std::span<const WordRoles> rows, std::string_view word) {
    for (const WordRoles& row : rows)
        if (matchesAny(word, row.patterns)) return row.role;
    return BrushRole::kUnknown;
}

/// Of `surfaceparm`: kSolid says nothing against it. The last rows are sounds of steps and their kin.
constexpr WordRoles kParms[] = {
    {"water slime lava", BrushRole::kLiquid},
    {"sky", BrushRole::kSky},
    {"fog trans nonsolid nonopaque detail hint skip areaportal clusterportal antiportal donotenter origin trigger "
     "nodrop "
     "playerclip monsterclip botclip shotclip missileclip body corpse alphashadow lightfilter glass ladder forcefield "
     "insideoutside outside inside",
     BrushRole::kNothing},
    {"structural nodraw nodamage slick noimpact nomarks noflesh nosteps nolightmap nodlight pointlight lightgrid flesh "
     "dust "
     "monsterslick* landmine splash nomiscents",
     BrushRole::kSolid},
    {"metal metalsteps woodsteps grasssteps gravelsteps carpetsteps snowsteps roofsteps masonry ceramic wood stone "
     "rubble "
     "grass gravel carpet snow roof",
     BrushRole::kSolid},
};

/// Words of the outer level that open a surface, wherever on a line they are: games take several in a row.
constexpr std::string_view kOpenOuter =
    "deformvertexes portal q3map_invert q3map_offset q3map_terrain implicitmask implicitblend fogparms fogonly";

/// Words that begin a line there and say nothing against a solid surface; what some of them do is looked at besides.
constexpr std::string_view kPlainOuter =
    "skyparms surfaceparm cull qer_* light lightning nomipmaps nopicmip nocompress allowcompress polygonoffset "
    "entitymergable implicitmap tesssize sort hitlocation hitmaterial sunshader q3map_sun* q3map_surfacelight "
    "q3map_lightimage q3map_lightsubdivide q3map_backsplash q3map_tesssize q3map_globaltexture q3map_bouncescale "
    "q3map_bounce q3map_nonplanar q3map_shadeangle q3map_lightmap* q3map_normalimage q3map_novertex* q3map_vertexscale "
    "q3map_forcemeta q3map_flare q3map_flareshader q3map_skylight q3map_splotchfix q3map_lightrgb q3map_lightstyle "
    "q3map_tcgen q3map_tcmod q3map_floodlight q3map_material q3map_tracelight q3map_nofast q3map_patchshadows "
    "q3map_vertexshadows q3map_backshader q3map_surfacemodel q3map_stylemarker* q3map_onlyvertexlighting "
    "q3map_alphamod "
    "q3map_notjunc q3map_forcesunlight";

/// The same of the first stage, which alone decides whether pixels are covered.
constexpr std::string_view kOpenStage = "blendfunc alphafunc depthfunc";
constexpr std::string_view kPlainStage =
    "map clampmap animmap clampanimmap oneshotanimmap videomap rgbgen alphagen tcgen texgen tcmod depthwrite glow "
    "nolightscale";

class ScriptReader {
public:
    ScriptReader(std::string_view text, MapMaterials& out) : text_(text), out_(out) {}

    /// The fault, or nothing.
    std::string run() {
        if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
        while (fault_.empty() && next(true)) {
            if (word_ == "{" || word_ == "}") {
                fail(fmt::format("\"{}\" where the name of a shader was expected", word_));
                break;
            }
            readShader(nameOfTexture(word_));
        }
        return fault_;
    }

private:
    void fail(const std::string& what) { failAt(line_, what); }
    void failAt(uint32_t line, const std::string& what) {
        if (fault_.empty()) fault_ = fmt::format("line {}: {}", line, what);
    }

    bool isBlank(char c) const { return static_cast<unsigned char>(c) <= ' '; }

    /// Takes the next word in small letters; false at the end, and at the line's end unless lines may be crossed.
    bool next(bool across) {
        for (;;) {
            while (at_ < text_.size() && isBlank(text_[at_])) {
                if (text_[at_] == '\n') {
                    if (!across) return false;
                    ++line_;
                }
                ++at_;
            }
            const std::string_view rest = text_.substr(at_);
            if (rest.starts_with("//")) {
                at_ = std::min(text_.find('\n', at_), text_.size());
            } else if (rest.starts_with("/*")) {
                const size_t end = text_.find("*/", at_ + 2);
                const size_t stop = end == std::string_view::npos ? text_.size() : end + 2;
                line_ += static_cast<uint32_t>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                                                          text_.begin() + static_cast<std::ptrdiff_t>(stop), '\n'));
                at_ = stop;
            } else {
                break;
            }
        }
        if (at_ >= text_.size()) return false;
        const size_t first = at_;
        if (text_[at_] == '"') {
            const size_t end = std::min(text_.find_first_of("\"\n", at_ + 1), text_.size());
            word_.assign(text_.substr(at_ + 1, end - at_ - 1));
            at_ = end < text_.size() && text_[end] == '"' ? end + 1 : end;
        } else {
            // As the games do: a brace is a word of its own only between blanks.
            while (at_ < text_.size() && !isBlank(text_[at_])) ++at_;
            word_.assign(text_.substr(first, at_ - first));
        }
        for (char& c : word_)
            if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
        return true;
    }

    /// The words of the line that begins with the word just taken; a brace ends it.
    void readLine() {
        words_.assign(1, word_);
        for (;;) {
            const size_t at = at_;
            if (!next(false)) return;
            if (word_ == "{" || word_ == "}") {
                at_ = at;
                return;
            }
            words_.push_back(word_);
        }
    }
    std::string_view wordAt(size_t i) const { return i < words_.size() ? std::string_view(words_[i]) : ""; }

    void worsen(BrushRole role) { role_ = std::max(role_, role); }

    void readShader(const std::string& name) {
        const uint32_t line = line_;
        if (!next(true) || word_ != "{") return failAt(line, fmt::format("shader {} has no body", oneLine(name, 80)));
        role_ = BrushRole::kSolid;
        stages_ = 0;
        not_drawn_ = editor_clear_ = implicit_ = false;
        for (;;) {
            if (!next(true)) return fail(fmt::format("the file ends within shader {}", oneLine(name, 80)));
            if (word_ == "}") break;
            if (word_ == "{") {
                if (!readStage()) return fail(fmt::format("the file ends within shader {}", oneLine(name, 80)));
                continue;
            }
            readLine();
            takeOuter();
        }
        // Without a stage nothing is drawn. Caulk and its kin are meant so: they are solid, and nobody comes to see them.
        // What an editor shows as glass is seldom a wall.
        if (role_ == BrushRole::kSolid && !not_drawn_ && (editor_clear_ || (stages_ == 0 && !implicit_)))
            worsen(BrushRole::kUnknown);
        out_.addShader(name, role_);
    }

    void takeOuter() {
        if (!matchesAny(words_[0], kPlainOuter) && !matchesAny(words_[0], kOpenOuter)) worsen(BrushRole::kUnknown);
        for (size_t i = 0; i < words_.size(); ++i) {
            const std::string_view word = words_[i], next = wordAt(i + 1);
            if (matchesAny(word, kOpenOuter)) worsen(BrushRole::kNothing);
            if (word == "surfaceparm") worsen(roleIn(kParms, next));
            not_drawn_ |= word == "surfaceparm" && next == "nodraw";
            // Fronts are left out: one sees into the brush.
            if (word == "cull" && next.starts_with("back")) worsen(BrushRole::kNothing);
            editor_clear_ |= word == "qer_trans";
            implicit_ |= word == "implicitmap";
            if (word == "skyparms") worsen(BrushRole::kSky);
        }
    }

    /// The brace is taken; false if the file ends first.
    bool readStage() {
        const bool decides = stages_++ == 0;
        bool has_map = false;
        uint32_t depth = 1;
        while (depth > 0) {
            if (!next(true)) return false;
            if (word_ == "{" || word_ == "}") {
                // Nothing of the family has braces within stages.
                if (word_ == "{") worsen(BrushRole::kUnknown);
                depth += word_ == "{" ? 1u : ~0u;
                continue;
            }
            readLine();
            if (!decides) continue;
            if (!matchesAny(words_[0], kPlainStage) && !matchesAny(words_[0], kOpenStage)) worsen(BrushRole::kUnknown);
            for (size_t i = 0; i < words_.size(); ++i) {
                const bool opaque_blend =
                    words_[i] == "blendfunc" && wordAt(i + 1) == "gl_one" && wordAt(i + 2) == "gl_zero";
                if (matchesAny(words_[i], kOpenStage) && !opaque_blend) worsen(BrushRole::kNothing);
                has_map |= words_[i].ends_with("map");
            }
        }
        // Games leave a stage without a picture out; then another one decides.
        if (decides && !has_map) worsen(BrushRole::kUnknown);
        return true;
    }

    std::string_view text_;
    MapMaterials& out_;
    size_t at_ = 0;
    uint32_t line_ = 1;
    std::string word_, fault_;
    std::vector<std::string> words_;
    BrushRole role_ = BrushRole::kSolid;
    uint32_t stages_ = 0;
    bool not_drawn_ = false, editor_clear_ = false, implicit_ = false;
};

}  // namespace

Status parseShaderScript(std::span<const unsigned char> bytes, const std::string& name, MapMaterials& out) {
    ScriptReader reader({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, out);
    const std::string fault = reader.run();
    if (!fault.empty()) return Error{Error::Kind::kInput, fmt::format("{}: {}", name, fault)};
    return success();
}

}  // namespace sightline::tools
