#include "sim/dataset/restormer_options.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace shimmer::dataset {
namespace {

// @NAME@: output.name inside double quotes, which YAML reads as JSON does.
constexpr const char* kTraining =
    R"yml(# Trains Restormer on this data set, with its own training code (swz30/Restormer, basicsr/train.py).
# The numbers are those of its deblurring recipe: 300,000 iterations on 8 GPUs, patches that grow while batches shrink.
#
#   cd Restormer                                # its checkout, installed as its INSTALL.md says
#   ln -s THIS_FOLDER "@NAME@"                  # the folder that holds this file
#   ./train.sh "@NAME@/restormer.yml"
#
# train.sh starts 8 processes, one a GPU. On one GPU set num_gpu to 1 and run
#   python basicsr/train.py -opt "@NAME@/restormer.yml"
# Models, states and the log go to experiments/ of the checkout; started again from there, it goes on by itself.
# The loader reads 8 bits and three channels: PNG of 16 bits loses half of them, and EXR is not read.

name: "Restormer_@NAME@"
model_type: ImageCleanModel
scale: 1
num_gpu: 8
manual_seed: 100

datasets:
  train:
    name: TrainSet
    type: Dataset_PairedImage
    dataroot_gt: "@NAME@/train/gt"
    dataroot_lq: "@NAME@/train/lq"
    meta_info_file: "@NAME@/train/meta_info.txt"  # without it the folders are paired by a search of n * n steps
    geometric_augs: true
    filename_tmpl: "{}"
    io_backend:
      type: disk

    use_shuffle: true
    num_worker_per_gpu: 8
    batch_size_per_gpu: 8  # a GPU needs at least so many pairs; with fewer it waits for ever: raise dataset_enlarge_ratio
    dataset_enlarge_ratio: 1
    prefetch_mode: null

    # Progressive learning: each entry is used for so many iterations. No patch is larger than the frames.
    mini_batch_sizes: [8, 5, 4, 2, 1, 1]
    iters: [92000, 64000, 48000, 36000, 36000, 24000]
    gt_sizes: [@GT_SIZES@]
    gt_size: @GT_SIZE@

)yml";

constexpr const char* kTestSet = R"yml(  val:
    name: ValSet
    type: Dataset_PairedImage
    dataroot_gt: "@NAME@/test/gt"
    dataroot_lq: "@NAME@/test/lq"
    meta_info_file: "@NAME@/test/meta_info.txt"
    io_backend:
      type: disk
)yml";

constexpr const char* kNetwork = R"yml(
network_g:
  type: Restormer
  inp_channels: 3
  out_channels: 3
  dim: 48
  num_blocks: [4, 6, 6, 8]
  num_refinement_blocks: 4
  heads: [1, 2, 4, 8]
  ffn_expansion_factor: 2.66
  bias: false
  LayerNorm_type: WithBias
  dual_pixel_task: false

path:
  pretrain_network_g: null
  strict_load_g: true
  resume_state: null

train:
  total_iter: 300000
  warmup_iter: -1
  use_grad_clip: true

  # 3e-4 for 92,000 iterations, then down to 1e-6 along a cosine.
  scheduler:
    type: CosineAnnealingRestartCyclicLR
    periods: [92000, 208000]
    restart_weights: [1, 1]
    eta_mins: [0.0003, 0.000001]

  mixing_augs:
    mixup: false
    mixup_beta: 1.2
    use_identity: true

  optim_g:
    type: AdamW
    lr: 0.0003
    weight_decay: 0.0001
    betas: [0.9, 0.999]

  pixel_opt:
    type: L1Loss
    loss_weight: 1
    reduction: mean

)yml";

constexpr const char* kValidation = R"yml(val:
  window_size: 8
  val_freq: 4000
  save_img: false
  rgb2bgr: true
  use_image: true
  max_minibatch: 8

  metrics:
    psnr:
      type: calculate_psnr
      crop_border: 0
      test_y_channel: false
)yml";

constexpr const char* kRest = R"yml(
logger:
  print_freq: 1000
  save_checkpoint_freq: 4000
  use_tb_logger: true
  wandb:
    project: null
    resume_id: null

dist_params:
  backend: nccl
  port: 29500
)yml";

std::string Replaced(std::string text, const std::string& what, const std::string& by) {
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

}  // namespace

std::string RestormerOptions(const std::string& name, int64_t smallest_side_px, bool with_test) {
  // The network halves its input three times.
  const int64_t largest = std::max<int64_t>(8, smallest_side_px / 8 * 8);
  std::string patches;
  for (const int64_t recipe : {128, 160, 192, 256, 320, 384})
    patches += (patches.empty() ? "" : ", ") + std::to_string(std::min(recipe, largest));
  const std::string quoted =
      nlohmann::json(name).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);

  std::string text = std::string(kTraining) + (with_test ? kTestSet : "") + kNetwork +
                     (with_test ? kValidation : "") + kRest;
  text = Replaced(text, "@NAME@", quoted.substr(1, quoted.size() - 2));
  text = Replaced(text, "@GT_SIZES@", patches);
  return Replaced(text, "@GT_SIZE@", std::to_string(std::min<int64_t>(384, largest)));
}

}  // namespace shimmer::dataset
