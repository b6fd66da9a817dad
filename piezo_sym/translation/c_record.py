"""The record of a printed step's parameters, and what fills it, taken word for word.

Input: the tokens of ``<model>_step.c``, and its model.  Output: nothing; what is not as it has to
be is refused.
"""

from typing import final

from piezo_sym.spec.model import Model
from piezo_sym.spec.tables import banks, lane_parameters
from piezo_sym.translation.c_text import Tokens
from piezo_sym.translation.field import NotShownError


@final
class Record:
    """The record ``<model>_reals``, read when this is made; in the order in which it is filled."""

    def __init__(self, tokens: Tokens, model: Model) -> None:
        self.tokens, self.model = tokens, model
        self.own, self.banks = lane_parameters(model), [*banks(model)]
        self.fields: dict[str, str] = {}
        counts = [f"{bank}_count" for bank in self.banks]
        tokens.take("typedef", "struct", "{")
        for name in (*model.parameters, *counts):
            words = "double *" if name in self.own else "long" if name in counts else "double"
            tokens.take(*words.split())
            word = self.fields[name] = tokens.word()
            if word.rstrip("_") != name.rstrip("_"):
                raise NotShownError(f"the record of parameters has no {name} at its place")
            tokens.take(";")
        if not self.fields:
            tokens.take("char", "none", ";")
        tokens.take("}", f"{model.name}_reals", ";")

    def take_place(self) -> None:
        """Take the function that says where the parameters of lanes stand."""
        counts = [self.fields[f"{bank}_count"] for bank in self.banks]
        words = [] if counts else ["( void ) to ; ( void ) from ;"]
        words += ["double * const begin = at ;"]
        words += [f"to -> {count} = from -> {count} ;" for count in counts]
        for name, bank in self.own.items():
            words.append(f"to -> {self.fields[name]} = at ;")
            words.append(f"at += from -> {self.fields[f'{bank}_count']} ;")
        self._take("long", "place_reals", "double * at", [*words, "return at - begin ;"])

    def take_give(self) -> None:
        """Take the function that gives a lane the parameters of a run."""
        words = ["( void ) lane ;"]
        for name in self.model.parameters:
            field = self.fields[name]
            if name in self.own:
                count = self.fields[f"{self.own[name]}_count"]
                words.append(f"for ( long j = 0 ; j < from -> {count} ; ++ j )")
                words.append(f"OF ( to -> {field} [ j ] , lane ) = from -> {field} [ j ] ;")
            else:
                words.append(f"OF ( to -> {field} , lane ) = from -> {field} ;")
        words += [] if self.model.parameters else ["( void ) to ; ( void ) from ;"]
        self._take("void", "give", "int lane", words)

    def _take(self, kind: str, name: str, last: str, words: list[str]) -> None:
        model = self.model.name
        head = f"{kind} {model}_{name} ( {model}_reals * to , const {model}_parameters * from"
        self.tokens.take(*f"{head} , {last} )".split(), "{", *" ".join(words).split(), "}")
