"""The rules (thesis 3.2): one a file, each a pure function of the threat and of a control between 0 and 1.

`behaviours.protect.apply_rules` calls them in their order. To change one, change its function or its constants in
`settings`; `brace pose` and `brace figure 3.3` (lean; 3.4 turn, 3.5 recoil, 3.6 block) show what comes of it.

To add one: a file here; its constants, a group of `settings.Settings`; that group among `protect.task.Rules`, filled
in `protect.prepare.rules_of` and passed on in `protect.arm_wishes.beside_head`; and its call in
`protect.apply_rules.place_trunk`, or in `protect.guard` for an arm. What it chooses is chosen once, in `prepare`.
"""
