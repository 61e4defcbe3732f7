# SPDX-License-Identifier: MIT
"""The paper's networks from their public Python packages, wrapped so that crossnav's adapters can use their exports.

Each function takes a `Wish` and gives a `Made`: modules with their inputs, and the lines of the card. With `small` the same classes are built with few
channels, for tests; without weights they are random, by the seed.
"""

import dataclasses
import sys

import torch
from torch import nn

from yolov7_layers import yolov7_description

GOALS = ["chair", "bed", "plant", "toilet", "tv_monitor", "sofa"]
IMAGENET = 'scale = 0.003921568627450980\nmean = [0.485, 0.456, 0.406]\ndeviation = [0.229, 0.224, 0.225]'


@dataclasses.dataclass
class Wish:
    weights: str = ""  # file or folder; empty = random
    labels: list = dataclasses.field(default_factory=lambda: list(GOALS))
    small: bool = False
    size: int = 0  # side of the input [px]; 0 = the network's own
    clip: str = ""  # folder of a CLIP text model, for YOLO-World's words
    seed: int = 1


@dataclasses.dataclass
class Part:
    """One ONNX file."""

    suffix: str  # of the file's name; "" for the first
    module: nn.Module
    inputs: dict  # name -> example
    outputs: list


@dataclasses.dataclass
class Made:
    parts: list
    card: str
    size: int = 0


class Calls(nn.Module):
    """A function of a model as a module."""

    def __init__(self, model, function):
        super().__init__()
        self.model = model
        self.function = function

    def forward(self, *inputs):
        return self.function(self.model, *inputs)


def image(size):
    return torch.rand(1, 3, size, size)


def labels_line(labels):
    return "labels = [" + ", ".join(f'"{label}"' for label in labels) + "]"


def segformer_b2(wish):
    """Stairs: SegFormer-B2 on ADE20K (transformers). Weights: a folder of from_pretrained."""
    from transformers import SegformerConfig, SegformerForSemanticSegmentation

    if wish.weights:
        model = SegformerForSemanticSegmentation.from_pretrained(wish.weights)
    elif wish.small:
        model = SegformerForSemanticSegmentation(SegformerConfig(
            hidden_sizes=[8, 16, 24, 32], depths=[1, 1, 1, 1], num_attention_heads=[1, 1, 2, 2], decoder_hidden_size=16, num_labels=150))
    else:
        model = SegformerForSemanticSegmentation(SegformerConfig(
            hidden_sizes=[64, 128, 320, 512], depths=[3, 4, 6, 3], decoder_hidden_size=768, num_labels=150))
    size = wish.size or (64 if wish.small else 512)
    part = Part("", Calls(model.eval(), lambda m, x: m(pixel_values=x).logits), {"pixel_values": image(size)}, ["logits"])
    # ADE20K: 53 stairs, 59 stairway, 96 escalator, 121 step (transformers' numbers, from 0).
    card = f'family = "segformer"\n[input]\nsize = {size}\n{IMAGENET}\n[output]\nclasses = 150\nstair_classes = [53, 59, 121]\n'
    return Made([part], card, size)


def clip_text(wish):
    """Text vectors: CLIP's text model (transformers). Weights: a folder of from_pretrained, ViT-B/32 or another."""
    from transformers import CLIPTextConfig, CLIPTextModelWithProjection

    if wish.weights:
        model = CLIPTextModelWithProjection.from_pretrained(wish.weights)
    elif wish.small:
        model = CLIPTextModelWithProjection(CLIPTextConfig(
            vocab_size=1346, hidden_size=32, intermediate_size=64, num_hidden_layers=2, num_attention_heads=2, projection_dim=16,
            bos_token_id=1344, eos_token_id=1345, pad_token_id=1345))
    else:
        model = CLIPTextModelWithProjection(CLIPTextConfig(bos_token_id=1344, eos_token_id=1345, pad_token_id=1345))  # the tests' merges
    length = model.config.max_position_embeddings
    ids = torch.full((1, length), model.config.eos_token_id, dtype=torch.int64)
    ids[0, 0] = model.config.bos_token_id
    part = Part("", Calls(model.eval(), lambda m, x: m(input_ids=x).text_embeds), {"input_ids": ids}, ["text_embeds"])
    lines = f'encoder = "clip_text.onnx"\ntokenizer = "clip"\nvocabulary = "merges.txt"\nlength = {length}\n'
    return Made([part], "# These lines belong into the card of the image encoder.\n[text]\n" + lines)


def mobile_sam(wish):
    """Masks: MobileSAM (mobile_sam), in two files. Weights: mobile_sam.pt."""
    from mobile_sam import build_sam_vit_t, modeling
    from mobile_sam.modeling import tiny_vit_sam

    if wish.small:
        sam = small_sam(modeling, tiny_vit_sam.TinyViT)
    else:
        sam = build_sam_vit_t(None)
    if wish.weights:
        sam.load_state_dict(torch.load(wish.weights, map_location="cpu", weights_only=True))
    sam.eval()
    size = sam.image_encoder.img_size
    with torch.no_grad():
        embeddings = sam.image_encoder(image(size))
    box = torch.tensor([[0.2, 0.2, 0.7, 0.8]]) * size
    parts = [Part("", Calls(sam, lambda m, x: m.image_encoder(x)), {"image": image(size)}, ["embeddings"]),
             Part("_decoder", Calls(sam, decode_box), {"embeddings": embeddings, "box": box}, ["mask", "quality"])]
    mean, deviation = ([float(v) for v in t.flatten()] for t in (sam.pixel_mean, sam.pixel_std))
    _, dim, rows, cols = embeddings.shape
    card = (f'family = "mobile-sam"\ndecoder = "mobile_sam_decoder.onnx"\n[input]\nsize = {size}\nresize = "corner"\nscale = 1.0\n'
            f"mean = {[round(v, 4) for v in mean]}\ndeviation = {[round(v, 4) for v in deviation]}\n"
            f"[output]\nrows = {rows}\ncols = {cols}\ndim = {dim}\n")
    return Made(parts, card, size)


def decode_box(sam, embeddings, box):
    """The first mask of a box, on the decoder's grid, and its predicted overlap."""
    sparse, dense = sam.prompt_encoder(points=None, boxes=box, masks=None)
    masks, quality = sam.mask_decoder(image_embeddings=embeddings, image_pe=sam.prompt_encoder.get_dense_pe(),
                                      sparse_prompt_embeddings=sparse, dense_prompt_embeddings=dense, multimask_output=False)
    return masks, quality


def small_sam(modeling, TinyViT):
    side, dim = 1024, 16  # the class works at this size only
    encoder = TinyViT(img_size=side, in_chans=3, num_classes=10, embed_dims=[8, 16, 16, 16], depths=[1, 1, 1, 1], num_heads=[1, 2, 2, 2],
                      window_sizes=[4, 4, 4, 4], mlp_ratio=2.0, drop_rate=0.0, drop_path_rate=0.0, use_checkpoint=False,
                      mbconv_expand_ratio=2.0, local_conv_size=3, layer_lr_decay=0.8)
    encoder.layers[2].downsample.conv2.c.stride = (1, 1)  # as for the real width
    encoder.neck[0] = nn.Conv2d(16, dim, 1, bias=False)
    for i, size in ((1, dim), (3, dim)):
        encoder.neck[i] = type(encoder.neck[i])(size)
    encoder.neck[2] = nn.Conv2d(dim, dim, 3, padding=1, bias=False)
    decoder = modeling.MaskDecoder(num_multimask_outputs=3, transformer=modeling.TwoWayTransformer(
        depth=1, embedding_dim=dim, mlp_dim=16, num_heads=2), transformer_dim=dim, iou_head_depth=2, iou_head_hidden_dim=16)
    prompts = modeling.PromptEncoder(embed_dim=dim, image_embedding_size=(side // 16, side // 16), input_image_size=(side, side), mask_in_chans=4)
    return modeling.Sam(encoder, prompts, decoder, [123.675, 116.28, 103.53], [58.395, 57.12, 57.375])


def yolox(wish):
    """Boxes: YOLOX (yolox). Weights: a checkpoint of YOLOX-S."""
    from yolox.models import YOLOX, YOLOPAFPN, YOLOXHead

    width = 0.0625 if wish.small else 0.50
    model = YOLOX(YOLOPAFPN(0.33, width), YOLOXHead(len(wish.labels), width))
    if wish.weights:
        model.load_state_dict(torch.load(wish.weights, map_location="cpu", weights_only=False)["model"])
    model.eval().head.decode_in_inference = False
    size = wish.size or (64 if wish.small else 640)
    card = f'family = "yolox"\n{labels_line(wish.labels)}\n[input]\nsize = {size}\nresize = "corner"\ncolour = "bgr"\nscale = 1.0\nantialias = false\n'
    return Made([Part("", model, {"images": image(size) * 255}, ["output"])], card, size)


def ultralytics_model(wish, name, kind):
    """One of ultralytics' models from its own description, narrow where small."""
    from ultralytics import YOLO, YOLOWorld
    from ultralytics.nn import tasks
    from ultralytics.utils import YAML
    from ultralytics.utils.checks import check_yaml

    if wish.weights:
        return (YOLOWorld if kind == "WorldModel" else YOLO)(wish.weights).model.float()
    description = YAML.load(check_yaml(name))
    if wish.small:
        description["scales"] = {"s": [0.33, 0.0625, 1024], "n": [0.33, 0.0625, 1024]}
        description["head"][-1][3] = [len(wish.labels), 8, 32] if kind == "SegmentationModel" else description["head"][-1][3]
    description["scale"] = "n" if "8-" in name else "s"
    return getattr(tasks, kind)(description, nc=len(wish.labels), verbose=False)


def prepared(model):
    """As ultralytics' exporter sets it up."""
    model = model.eval()
    head = model.model[-1]
    head.export, head.format, head.dynamic = True, "onnx", False
    return model


def yolov8_seg(wish):
    """Boxes and masks: YOLOv8-seg (ultralytics). Weights: yolov8*-seg.pt."""
    model = prepared(ultralytics_model(wish, "yolov8-seg.yaml", "SegmentationModel"))
    size = wish.size or (64 if wish.small else 640)
    labels = list(model.names.values()) if wish.weights else wish.labels
    card = (f'family = "yolov8-seg"\n{labels_line(labels)}\n[input]\nsize = {size}\nresize = "letterbox"\nantialias = false\n'
            f"[output]\ndim = {model.model[-1].nm}\n")
    return Made([Part("", Calls(model, lambda m, x: tuple(m(x))), {"images": image(size)}, ["output0", "output1"])], card, size)


def yolo_world(wish):
    """Boxes of any words: YOLO-World (ultralytics) with the labels' text vectors baked in. Weights: yolov8*-worldv2.pt (the first version cannot be
    exported); `clip`: a folder of
    CLIP ViT-B/32 for transformers."""
    model = prepared(ultralytics_model(wish, "yolov8-worldv2.yaml", "WorldModel"))
    model.txt_feats = words(wish)
    model.model[-1].nc = len(wish.labels)
    size = wish.size or (64 if wish.small else 640)
    card = f'family = "yolov8"\n{labels_line(wish.labels)}\n[input]\nsize = {size}\nresize = "letterbox"\nantialias = false\n'
    return Made([Part("", Calls(model, lambda m, x: m(x)), {"images": image(size)}, ["output0"])], card, size)


def yolo_world_open(wish):
    """The same with the words' vectors as a second input: the labels, and one place for any other goal. Weights: as above; the card wants the text
    network that `clip_text` writes."""
    from ultralytics.nn import tasks
    from ultralytics.utils import YAML
    from ultralytics.utils.checks import check_yaml

    dim, count = 16 if wish.small else 512, len(wish.labels) + 1
    if wish.small:
        description = YAML.load(check_yaml("yolov8-worldv2.yaml"))
        description["scales"], description["scale"] = {"s": [0.33, 0.0625, 256]}, "s"
        for row in description["head"]:
            row[3] += [dim] if row[2] == "C2fAttn" else []
        description["head"][-1][3] = [count, dim, True]
        short = type("Short", (tasks.WorldModel,), {"txt_feats": property(lambda _: torch.zeros(1, count, dim), lambda *_: None)})
        model = prepared(short(description, nc=count, verbose=False))  # initial words have 512 numbers
    else:
        model = prepared(ultralytics_model(wish, "yolov8-worldv2.yaml", "WorldModel"))
    model.model[-1].nc = count
    if not wish.weights:  # initially all scores are zero and all boxes cover the picture
        for words_head, box_head in zip(model.model[-1].cv4, model.model[-1].cv2):
            words_head.bias.data.fill_(-1.0)
            words_head.logit_scale.data.fill_(1.5)
            box_head[-1].bias.data.copy_(torch.linspace(2, -2, 16).repeat(4))
    vectors = torch.randn(1, count, dim)
    size = wish.size or (64 if wish.small else 640)
    merges = "../tokens/merges.txt" if wish.small else "merges.txt"
    card = (f'family = "yolo-world"\n{labels_line(wish.labels)}\n[input]\nsize = {size}\nresize = "letterbox"\nantialias = false\n'
            f"[output]\nclasses = {count}\ndim = {dim}\n"
            f'[text]\nencoder = "clip_text.onnx"\ntokenizer = "clip"\nvocabulary = "{merges}"\n')
    inputs = {"images": image(size), "texts": vectors / vectors.norm(dim=2, keepdim=True)}
    return Made([Part("", Calls(model, lambda m, x, texts: m.predict(x, txt_feats=texts)), inputs, ["output0"])], card, size)


def words(wish):
    """Unit text vectors of the labels, 1 x labels x 512; random without a CLIP model."""
    if wish.clip:
        from transformers import CLIPTextModelWithProjection, CLIPTokenizer

        tokens = CLIPTokenizer.from_pretrained(wish.clip)([x.replace("_", " ") for x in wish.labels], padding=True, return_tensors="pt")
        with torch.no_grad():
            vectors = CLIPTextModelWithProjection.from_pretrained(wish.clip)(**tokens).text_embeds
    else:
        vectors = torch.randn(len(wish.labels), 512)
    return (vectors / vectors.norm(dim=1, keepdim=True))[None]


def rtdetr(wish):
    """Boxes: RT-DETR (transformers). Weights: a folder of from_pretrained."""
    from transformers import RTDetrConfig, RTDetrForObjectDetection, RTDetrResNetConfig

    if wish.weights:
        model = RTDetrForObjectDetection.from_pretrained(wish.weights)
    elif wish.small:
        backbone = RTDetrResNetConfig(embedding_size=8, hidden_sizes=[8, 16, 16, 16], depths=[1, 1, 1, 1], layer_type="basic",
                                      out_features=["stage2", "stage3", "stage4"])
        model = RTDetrForObjectDetection(RTDetrConfig(
            backbone_config=backbone, encoder_in_channels=[16, 16, 16], encoder_hidden_dim=16, encoder_ffn_dim=16, encoder_attention_heads=2,
            d_model=16, num_queries=20, decoder_in_channels=[16, 16, 16], decoder_ffn_dim=16, decoder_layers=1, decoder_attention_heads=2,
            hidden_expansion=0.5, num_labels=len(wish.labels), disable_custom_kernels=True))
    else:
        model = RTDetrForObjectDetection(RTDetrConfig(num_labels=len(wish.labels), initializer_range=0.15))  # else all scores are equal
    size = wish.size or (64 if wish.small else 640)
    labels = list(model.config.id2label.values()) if wish.weights else wish.labels
    inputs = {"images": image(size), "orig_target_sizes": torch.tensor([[size, size]])}
    card = f'family = "detr"\n{labels_line(labels)}\n[input]\nsize = {size}\n'
    return Made([Part("", Calls(model.eval(), detections), inputs, ["labels", "boxes", "scores"])], card, size)


def detections(model, images, sizes):
    """RT-DETR's own postprocessing: the best pairs of box and class, boxes in pixels of a picture of `sizes` (width, height)."""
    found = model(pixel_values=images)
    likely = found.logits.sigmoid()
    queries, classes = likely.shape[1:]
    scores, index = torch.topk(likely.flatten(1), queries, dim=1)
    x, y, w, h = found.pred_boxes.unbind(-1)
    corners = torch.stack([x - w / 2, y - h / 2, x + w / 2, y + h / 2], -1) * sizes.float().repeat(1, 2)[:, None]
    box = index // classes
    return index - box * classes, corners.gather(1, box[..., None].expand(-1, -1, 4)), scores


def yolov7(wish):
    """Boxes: YOLOv7 with its grid (yolov7-package). Weights: a checkpoint of the original repository, which names its modules `models`."""
    import yolov7_package.models.common
    import yolov7_package.models.yolo

    if wish.weights:
        for name in ("models", "models.common", "models.yolo", "models.experimental"):
            sys.modules.setdefault(name, sys.modules["yolov7_package." + name])
        saved = torch.load(wish.weights, map_location="cpu", weights_only=False)
        model = (saved.get("ema") or saved["model"]).float()
        labels = list(model.names)
    else:
        model, labels = yolov7_package.models.yolo.Model(yolov7_description(len(wish.labels), 16 if wish.small else 1)), wish.labels
        for end in model.model[-1].m:  # as they begin, every score is nothing
            end.bias.data.zero_()
    model.eval().model[-1].concat = True
    size = wish.size or (64 if wish.small else 640)
    card = f'family = "yolov7"\n{labels_line(labels)}\n[input]\nsize = {size}\nresize = "letterbox"\nantialias = false\n'
    return Made([Part("", model, {"images": image(size)}, ["output"])], card, size)


def sed(wish):
    """Dense features and their text tower: the CLIP model of SED (Xie et al., CVPR 2024), open_clip's `convnext_large_d_320`, asked at every place of
    its last stage: 768 px give 24 x 24 x 768. Weights: SED's checkpoint (its keys end like open_clip's), or a checkpoint of open_clip alone."""
    import open_clip

    model = small_convnext_clip() if wish.small else open_clip.create_model("convnext_large_d_320", pretrained=None)
    if wish.weights:
        model.load_state_dict(clip_part(torch.load(wish.weights, map_location="cpu", weights_only=False)))
    model.eval()
    size = wish.size or (64 if wish.small else 768)
    with torch.no_grad():
        _, dim, rows, cols = dense_features(model, image(size)).shape
    length = model.context_length
    ids = torch.zeros(1, length, dtype=torch.int64)
    last = model.vocab_size - 1
    ids[0, :3] = torch.tensor([last - 1, 320, last])
    parts = [Part("", Calls(model, dense_features), {"image": image(size)}, ["features"]),
             Part("_text", Calls(model, text_features), {"input_ids": ids}, ["text_embeds"])]
    merges = "../tokens/merges.txt" if wish.small else "merges.txt"
    # Mean and deviation are CLIP's; the templates are those that SED calls "single" and CLIP's first.
    card = (f'family = "dense"\n[input]\nsize = {size}\nantialias = false\nmean = [0.48145466, 0.4578275, 0.40821073]\n'
            f'deviation = [0.26862954, 0.26130258, 0.27577711]\n[output]\nrows = {rows}\ncols = {cols}\ndim = {dim}\nlayout = "chw"\n'
            f'[text]\nencoder = "sed_text.onnx"\ntokenizer = "clip"\nvocabulary = "{merges}"\nlength = {length}\npadding = "zero"\n'
            'templates = ["A photo of a {} in the scene", "a photo of a {}."]\n')
    return Made(parts, card, size)


def dense_features(model, x):
    """The projection that open_clip applies to the pooled image, applied to every place of the last stage: 1 x dim x rows x cols."""
    trunk = model.visual.trunk
    x = trunk.norm_pre(trunk.stages(trunk.stem(x)))
    rows, cols = x.shape[2:]
    places = x.flatten(2).transpose(1, 2).reshape(rows * cols, x.shape[1], 1, 1)
    places = model.visual.head(trunk.head(places))
    return places.reshape(1, rows, cols, -1).permute(0, 3, 1, 2)


def text_features(model, ids):
    """open_clip's text tower; a text ends at its largest number."""
    return model.encode_text(ids)


def clip_part(saved):
    """The tensors of open_clip's model within a checkpoint of SED, of Detectron2 or of open_clip."""
    for key in ("model", "state_dict"):
        saved = saved.get(key, saved)
    inside = "clip_model."
    if any(inside in name for name in saved):
        saved = {name.split(inside, 1)[1]: value for name, value in saved.items() if inside in name}
    return {name.removeprefix("module."): torch.as_tensor(value) for name, value in saved.items()}


def small_convnext_clip():
    """open_clip's class around a ConvNeXt of few channels."""
    import open_clip
    from timm.models.convnext import ConvNeXt

    model = open_clip.CLIP(
        embed_dim=16,
        vision_cfg=open_clip.CLIPVisionCfg(timm_model_name="convnext_atto", timm_pool="", timm_proj="mlp", image_size=64),
        text_cfg=open_clip.CLIPTextCfg(context_length=77, vocab_size=1346, width=32, heads=2, layers=2))
    model.visual.trunk = ConvNeXt(depths=(1, 1, 1, 1), dims=(8, 8, 16, 16), num_classes=0, global_pool="avg")
    model.visual.head = model.visual.head.__class__()
    model.visual.head.append(nn.Linear(16, 32))
    model.visual.head.append(nn.GELU())
    model.visual.head.append(nn.Linear(32, 16, bias=False))
    return model


NETWORKS = {f.__name__: f for f in (segformer_b2, clip_text, mobile_sam, yolox, yolov8_seg, yolo_world, yolo_world_open, rtdetr, yolov7, sed)}
