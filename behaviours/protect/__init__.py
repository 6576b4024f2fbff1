"""The sustained pose (thesis 3.3): the rules applied, then a search that balances the body and braces it.

Begin with `protection.protect_from` (from the world to the pose and back) and `sustained.protect` (the pose itself).
"""
