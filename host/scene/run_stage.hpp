#pragma once
#include "io/words.hpp"

namespace selvage {

/// The stages of a run, in their order; their words stand in checkpoints, progress.jsonl and summary.json.
///     sew     panels are drawn together
///     press   seams that have just been joined are pressed
///     coarse  coarser cloths are draped, in place of both where a garment is sewn at the coarsest
///     drape   the cloth falls to rest, or for a time
#define RUN_STAGES(WORD) WORD(sew) WORD(press) WORD(coarse) WORD(drape)
WORD_ENUM(RunStage, RUN_STAGES)

}  // namespace selvage
