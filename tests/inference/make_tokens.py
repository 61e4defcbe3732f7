#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes data/tokens/: 1,000 texts of all scripts, small vocabularies (existing files are kept: their training breaks ties at random), and the output of the tokenizers of transformers (CLIPTokenizer,
BertTokenizer) for the texts; prints the agreement of open_clip's tokenizer. Needs networks/paper/requirements.txt.

    make_tokens.py bpe_simple_vocab_16e6.txt.gz vocab.txt

The two files are CLIP's merges and the vocabulary of bert-base-uncased (BERT_SHA256).
tokens.tsv: text; numbers with the small merges; with CLIP's own; with the small WordPiece vocabulary; with BERT's own.
"""
import gzip
import hashlib
import html
import json
import pathlib
import random
import sys
import unicodedata

from tokenizers import Tokenizer, models, pre_tokenizers, trainers
from transformers import BertTokenizer, CLIPTokenizer

BERT_SHA256 = "07eced375cec144d27c900241f3e339478dec958f92fddbc551f295c992038a3"
OUT = pathlib.Path(__file__).resolve().parent / "data" / "tokens"
WORDS = """a photo of a chair|the bed's frame, isn't it?|TV monitor|potted-plant #2|toilet (white)|sofa & couch|Küchentisch für Gäste|
canapé déplié|sillón español ¿dónde?|krzesło żółte|стул и стол|Диван ДЛЯ гостей|καρέκλα Σοφία|kanepe İstanbul|ghế sô pha|椅子和桌子|ソファとテレビ|
의자와 침대|कुर्सी और मेज़|கட்டில்|เก้าอี้โซฟา|كرسي وسرير|כיסא ומיטה|աթոռ|სკამი|ወንበር|🪑🛋️ 🚽|x²+½ = Ⅷ|don't we've they'll I'd I'm you're|naïve e\u0301tage|\u1e9b\u0323|
\ufb01le \u2126 \u212b|tab\tnew\nline\u00a0nbsp\u3000wide|soft\u00adhyphen zero\u200bwidth|  spaces   between  |...!!!---|ABC123def456|_under_score|100%""".replace("\n", "").split("|")
BLOCKS = [(0x20, 0x7E), (0xA1, 0x17F), (0x180, 0x24F), (0x370, 0x3FF), (0x400, 0x4FF), (0x531, 0x586), (0x5D0, 0x5EA), (0x621, 0x669),
          (0x904, 0x939), (0x980, 0x9FE), (0xB85, 0xBB9), (0xE01, 0xE5B), (0xE81, 0xEDF), (0xF40, 0xFBC), (0x1000, 0x109F), (0x10A0, 0x10FF),
          (0x1200, 0x135A), (0x13A0, 0x13F4), (0x1780, 0x17DC), (0x1820, 0x1877), (0x1E00, 0x1FFC), (0x2010, 0x205E), (0x20A0, 0x20BF),
          (0x2100, 0x218B), (0x2200, 0x22FF), (0x2460, 0x24FF), (0x3041, 0x30FF), (0x4E00, 0x9FA5), (0xAC00, 0xD7A3), (0xF900, 0xFA2D),
          (0xFF01, 0xFFDC), (0x10330, 0x1034A), (0x1D400, 0x1D7FF), (0x1F300, 0x1F64F), (0x20000, 0x2A6D6), (0x300, 0x36F)]


def texts():
    rng = random.Random(20)
    out = list(WORDS)
    while len(out) < 1000:
        if rng.random() < 0.3:
            out.append(" ".join(rng.sample(WORDS, 2)))
            continue
        first, last = rng.choice(BLOCKS)
        pool = [c for c in (chr(rng.randint(first, last)) for _ in range(14)) if known(c)]
        pool += rng.choices(" .,'1aÉ\u0301-", k=4)
        rng.shuffle(pool)
        out.append("".join(pool))
    return out


def known(c):
    """Assigned before Unicode 11, so that every library agrees."""
    return unicodedata.ucd_3_2_0.category(c) not in ("Cn", "Cs", "Co") or 0x1F300 <= ord(c) <= 0x1F5FF


def clip(merges):
    """transformers' CLIPTokenizer over these merges, with the vocabulary in CLIP's order."""
    listed = [*range(ord("!"), ord("~") + 1), *range(0xA1, 0xAD), *range(0xAE, 0x100)]
    letters = [chr(b) for b in listed] + [chr(256 + i) for i in range(256 - len(listed))]
    vocabulary = letters + [c + "</w>" for c in letters] + ["".join(m) for m in merges]
    vocabulary += ["<|startoftext|>", "<|endoftext|>"]
    return CLIPTokenizer(vocab={t: i for i, t in enumerate(vocabulary)}, merges=merges)


def small_merges(strings, count):
    tokenizer = Tokenizer(models.BPE(end_of_word_suffix="</w>"))
    tokenizer.pre_tokenizer = pre_tokenizers.Sequence([pre_tokenizers.Whitespace(), pre_tokenizers.ByteLevel(add_prefix_space=False)])
    trainer = trainers.BpeTrainer(vocab_size=512 + count, end_of_word_suffix="</w>", initial_alphabet=pre_tokenizers.ByteLevel.alphabet())
    tokenizer.train_from_iterator([s.lower() for s in strings], trainer)
    return [tuple(m) for m in json.loads(tokenizer.to_str())["model"]["merges"]]


def small_vocabulary(strings):
    pieces = Tokenizer(models.WordPiece(unk_token="[UNK]"))
    pieces.pre_tokenizer = pre_tokenizers.BertPreTokenizer()
    pieces.train_from_iterator([s.lower() for s in strings[:400]], trainers.WordPieceTrainer(
        vocab_size=1500, special_tokens=["[PAD]", "[UNK]", "[CLS]", "[SEP]", "[MASK]"]))
    vocabulary = pieces.get_vocab()
    return sorted(vocabulary, key=vocabulary.get)


def bert(path):
    """transformers' BertTokenizer over this vocabulary, a word a line."""
    return BertTokenizer(vocab={t: i for i, t in enumerate(path.read_text("utf-8").split("\n")[:-1])}, do_lower_case=True)


def escaped(text):
    return text.replace("\\", "\\\\").replace("\t", "\\t").replace("\n", "\\n").replace("\r", "\\r")


def main():
    own = pathlib.Path(sys.argv[2])
    if hashlib.sha256(own.read_bytes()).hexdigest() != BERT_SHA256:
        sys.exit(f"{own}: not the vocabulary of bert-base-uncased (SHA-256 {BERT_SHA256})")
    OUT.mkdir(parents=True, exist_ok=True)
    strings = texts()
    if not (OUT / "merges.txt").exists():
        (OUT / "merges.txt").write_text("#version: 0.2\n" + "".join(f"{a} {b}\n" for a, b in small_merges(strings, 700)))
    if not (OUT / "vocab.txt").exists():
        (OUT / "vocab.txt").write_text("".join(t + "\n" for t in small_vocabulary(strings)))
    merges = [tuple(line.split()) for line in (OUT / "merges.txt").read_text().splitlines()[1:]]
    lines = gzip.open(sys.argv[1], "rt", encoding="utf-8").read().split("\n")[1:49152 - 256 - 2 + 1]
    readers = [clip(merges), clip([tuple(line.split()) for line in lines]), bert(OUT / "vocab.txt"), bert(own)]
    rows = [[r(text)["input_ids"] for r in readers] for text in strings]
    compare_open_clip(strings, [numbers[1] for numbers in rows])
    with open(OUT / "tokens.tsv", "w", encoding="utf-8") as out:
        for text, numbers in zip(strings, rows):
            print(escaped(text), *(" ".join(map(str, n)) for n in numbers), sep="\t", file=out)


def compare_open_clip(strings, numbers):
    """Says on how many texts open_clip's tokenizer and transformers' agree: no tokenizer can equal both on the others."""
    import ftfy
    from open_clip.tokenizer import SimpleTokenizer

    tokenizer = SimpleTokenizer()
    others = [text for text, wanted in zip(strings, numbers)
              if [tokenizer.sot_token_id, *tokenizer.encode(text), tokenizer.eot_token_id] != wanted]
    mended = [t for t in others if html.unescape(html.unescape(ftfy.fix_text(t))) != unicodedata.normalize("NFC", t)]
    iota = [t for t in others if t not in mended and "\u0345" in unicodedata.normalize("NFC", t)]
    print(f"open_clip: {len(strings) - len(others)} of {len(strings)} texts as transformers; {len(mended)} others are mended by ftfy first, "
          f"{len(iota)} have U+0345, which its pattern takes for a letter, {len(others) - len(mended) - len(iota)} are others")


if __name__ == "__main__":
    main()
